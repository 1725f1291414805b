#include "capture/v4l2/v4l2_camera.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

#include "capture/v4l2/v4l2_device.h"
#include "capture/v4l2/v4l2_settings.h"
#include "core/error.h"
#include "core/text.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

bool all_digits(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return std::isdigit(static_cast<unsigned char>(c)) != 0;
    });
}

/// Entries of a folder; none if it cannot be read. Processes come and go meanwhile.
std::vector<fs::path> entries(const fs::path& folder) {
    std::vector<fs::path> found;
    std::error_code error;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
        found.push_back(i->path());
    return found;
}

std::vector<std::string> video_nodes() {
    constexpr std::string_view kName = "video";
    std::vector<std::string> nodes;
    for (const auto& path : entries("/dev")) {
        const std::string name = path.filename();
        if (name.substr(0, kName.size()) == kName && all_digits(name.substr(kName.size())))
            nodes.push_back(path);
    }
    // By number: of two names with this prefix the shorter one is the smaller number.
    std::sort(nodes.begin(), nodes.end(), [](const std::string& a, const std::string& b) {
        return a.size() != b.size() ? a.size() < b.size() : a < b;
    });
    return nodes;
}

bool may_open(const std::string& node) {
    return ::access(node.c_str(), R_OK | W_OK) == 0;
}

std::string first_line(const fs::path& path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    return line;
}

/// Of a USB camera, whose node hangs on an interface of the USB device.
std::string usb_serial(const std::string& node) {
    return first_line(fs::path("/sys/class/video4linux") / fs::path(node).filename() / "device" /
                      ".." / "serial");
}

/// "ffmpeg (process 123)" for other processes that have the node open, as far as we may see.
std::vector<std::string> users_of(const std::string& node) {
    std::vector<std::string> users;
    for (const auto& process : entries("/proc")) {
        const std::string id = process.filename();
        if (!all_digits(id) || id == std::to_string(::getpid())) continue;
        for (const auto& file : entries(process / "fd")) {
            std::error_code error;
            if (fs::read_symlink(file, error) != node || error) continue;
            users.push_back(fmt::format("{} (process {})", first_line(process / "comm"), id));
            break;
        }
    }
    return users;
}

DoctorFinding finding_of_node(const std::string& node) {
    using Level = DoctorFinding::Level;
    const std::string subject = "v4l2:" + node;
    try {
        const V4l2Device device(node);
        const auto formats = v4l2_format_names(device);
        const std::string what = fmt::format("{}, driver {}", device.card(), device.driver());
        if (formats.empty())
            return {Level::kWarning, subject, what + ", sends no raw format",
                    "choose another camera, or a mode of this one with raw pixels: v4l2-ctl -d " +
                        node + " --list-formats-ext"};
        const auto users = users_of(node);
        if (!users.empty())
            return {Level::kWarning, subject, what + ", is open in " + joined(users),
                    "close it there: one program at a time can stream"};
        return {Level::kGood, subject, what + ", sends " + joined(formats), ""};
    } catch (const DeviceError& error) {
        return {Level::kProblem, subject, error.what(), "see there"};
    }
}

/// Whether the device behind a node that can be opened captures at all; others are of no interest.
bool captures(const std::string& node) {
    try {
        const V4l2Device device(node);
        return true;
    } catch (const DeviceError&) {
        return false;
    }
}

}  // namespace

std::vector<CameraListing> list_v4l2_cameras() {
    std::vector<CameraListing> cameras;
    std::optional<DeviceError> refused;
    for (const auto& node : video_nodes()) {
        try {
            const V4l2Device device(node);
            cameras.push_back(
                {device.address(), "V4L2", device.driver(), device.card(), usb_serial(node)});
        } catch (const DeviceError& error) {
            if (!may_open(node)) refused = error;
        }
    }
    if (cameras.empty() && refused) throw *refused;
    return cameras;
}

std::vector<DoctorFinding> v4l2_findings() {
    using Level = DoctorFinding::Level;
    std::vector<DoctorFinding> findings;
    const auto nodes = video_nodes();
    const auto closed =
        std::count_if(nodes.begin(), nodes.end(), [](const auto& node) { return !may_open(node); });
    if (closed > 0)
        findings.push_back(
            {Level::kProblem, "group video",
             fmt::format("you may not open {} of {} video nodes", closed, nodes.size()),
             "sudo usermod -aG video $USER, then log in again"});
    for (const auto& node : nodes)
        if (may_open(node) && captures(node)) findings.push_back(finding_of_node(node));
    if (nodes.empty())
        findings.push_back({Level::kGood, "V4L2", "there is no video node (/dev/video*)", ""});
    else if (findings.empty())
        findings.push_back({Level::kGood, "V4L2", "no video node captures", ""});
    return findings;
}

}  // namespace stipple
