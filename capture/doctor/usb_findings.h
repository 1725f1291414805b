#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capture/doctor/doctor_finding.h"

namespace stipple {

/// What USB3 Vision cameras need of this machine: memory for transfers in flight (usbfs_memory_mb),
/// and leave to open the device. `root` is where the file system begins.
[[nodiscard]] std::vector<DoctorFinding> usb_findings(const std::filesystem::path& root = "/");

/// Whether a program of this machine has opened the USB3 Vision camera with this serial number.
[[nodiscard]] bool usb_camera_is_taken(const std::string& serial,
                                       const std::filesystem::path& root = "/");

}  // namespace stipple
