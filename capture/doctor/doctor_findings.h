#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

/// One result of `stipple capture doctor`.
struct DoctorFinding {
    enum class Level { kFact, kGood, kWarning, kProblem };
    Level level = Level::kGood;
    std::string subject;  ///< "receive buffer", "group video"
    std::string fact;     ///< finding, with numbers
    std::string fix;      ///< advice, if possible a command; empty if none is needed here
};

/// The hint of errors whose cause the doctor may find; its own findings do not have it.
inline constexpr std::string_view kAskDoctor = " (\"stipple capture doctor\")";

/// Network of this machine for the GigE Vision camera at "gige:IP", for all such cameras if the
/// address is empty: the interfaces that lead there with address and MTU, receive buffer,
/// permission for a larger one.
[[nodiscard]] std::vector<DoctorFinding> examine_network(const std::string& address);

/// Finding on the receive buffer for a net.core.rmem_max of `max_bytes` (0: unknown), which this
/// program may exceed or not.
[[nodiscard]] DoctorFinding judge_receive_buffer(std::int64_t max_bytes, bool may_exceed);

/// Finding on the packet size that a path of this MTU carries.
[[nodiscard]] DoctorFinding judge_mtu(const std::string& interface, int mtu);

/// Findings on one GenICam camera: network interface, controlling program, packet size, pixel
/// format, features. Opens the camera for a moment; errors become findings. \throws InputError if
/// the address is none.
[[nodiscard]] std::vector<DoctorFinding> examine_genicam_camera(const std::string& address);

/// Requirements of USB3 Vision cameras: memory for transfers in flight (usbfs_memory_mb), and
/// permission to open the device. `root` is the root of the file system.
[[nodiscard]] std::vector<DoctorFinding> usb_findings(const std::filesystem::path& root = "/");

/// Whether a program on this machine has opened the USB3 Vision camera with this serial number.
[[nodiscard]] bool usb_camera_is_taken(const std::string& serial,
                                       const std::filesystem::path& root = "/");

}  // namespace stipple
