#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capture/doctor/doctor_finding.h"

namespace stipple {

/// Requirements of USB3 Vision cameras: memory for transfers in flight (usbfs_memory_mb), and
/// permission to open the device. `root` is the root of the file system.
[[nodiscard]] std::vector<DoctorFinding> usb_findings(const std::filesystem::path& root = "/");

/// Whether a program on this machine has opened the USB3 Vision camera with this serial number.
[[nodiscard]] bool usb_camera_is_taken(const std::string& serial,
                                       const std::filesystem::path& root = "/");

}  // namespace stipple
