#include "capture/doctor/doctor_findings.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>

#include "capture/camera.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;
using Level = DoctorFinding::Level;

constexpr std::int64_t kEnoughMb = 256;  // 32 buffers of 8 MB

std::string first_line(const fs::path& path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    return line;
}

std::optional<std::int64_t> number_in(const fs::path& path) {
    return integer_setting(first_line(path));
}

std::vector<fs::path> entries(const fs::path& folder) {
    std::vector<fs::path> found;
    std::error_code error;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
        found.push_back(i->path());
    std::sort(found.begin(), found.end());
    return found;
}

DoctorFinding memory_finding(const fs::path& root) {
    const char* const subject = "USB memory";
    const auto megabytes = number_in(root / "sys/module/usbcore/parameters/usbfs_memory_mb");
    if (!megabytes) return {Level::kGood, subject, "this machine has no USB", ""};
    const std::string fact = fmt::format("usbfs_memory_mb is {}", *megabytes);
    if (*megabytes == 0 || *megabytes >= kEnoughMb)  // 0: no limit
        return {Level::kGood, subject, fact, ""};
    return {Level::kWarning, subject, fact + ", too little for many large frames in flight",
            "echo 1000 | sudo tee /sys/module/usbcore/parameters/usbfs_memory_mb; for good: "
            "usbcore.usbfs_memory_mb=1000 on the kernel's command line"};
}

/// The interfaces of class EF, subclass 05: those of USB3 Vision.
std::vector<fs::path> vision_interfaces(const fs::path& device) {
    std::vector<fs::path> interfaces = entries(device);
    std::erase_if(interfaces, [](const fs::path& interface) {
        return first_line(interface / "bInterfaceClass") != "ef" ||
               first_line(interface / "bInterfaceSubClass") != "05";
    });
    return interfaces;
}

bool is_usb3_vision(const fs::path& device) {
    return !vision_interfaces(device).empty();
}

/// The driver "usbfs" is a program that has claimed the interface.
bool is_claimed(const fs::path& interface) {
    std::error_code error;
    return fs::read_symlink(interface / "driver", error).filename() == "usbfs";
}

DoctorFinding access_finding(const fs::path& root, const fs::path& device) {
    const auto bus = number_in(device / "busnum").value_or(0);
    const auto number = number_in(device / "devnum").value_or(0);
    const fs::path node = root / fmt::format("dev/bus/usb/{:03}/{:03}", bus, number);
    const std::string subject = fmt::format("usb:{}", first_line(device / "serial"));
    const std::string what =
        fmt::format("{} {} at {} Mbit/s", first_line(device / "manufacturer"),
                    first_line(device / "product"), first_line(device / "speed"));
    if (::access(node.c_str(), R_OK | W_OK) != 0)
        return {Level::kProblem, subject, what + ", which you may not open",
                fmt::format("write SUBSYSTEM==\"usb\", ATTR{{idVendor}}==\"{}\", MODE=\"0666\" to "
                            "/etc/udev/rules.d/70-cameras.rules, then unplug and plug in",
                            first_line(device / "idVendor"))};
    if (number_in(device / "speed").value_or(0) < 5000)
        return {Level::kWarning, subject, what + ": this is USB 2",
                "use a USB 3 port and cable, without a hub"};
    return {Level::kGood, subject, what, ""};
}

}  // namespace

std::vector<DoctorFinding> usb_findings(const fs::path& root) {
    std::vector<DoctorFinding> findings{memory_finding(root)};
    for (const auto& device : entries(root / "sys/bus/usb/devices"))
        if (is_usb3_vision(device)) findings.push_back(access_finding(root, device));
    return findings;
}

bool usb_camera_is_taken(const std::string& serial, const fs::path& root) {
    const auto devices = entries(root / "sys/bus/usb/devices");
    return std::any_of(devices.begin(), devices.end(), [&](const fs::path& device) {
        if (first_line(device / "serial") != serial) return false;
        const auto interfaces = vision_interfaces(device);
        return std::any_of(interfaces.begin(), interfaces.end(), is_claimed);
    });
}

}  // namespace stipple
