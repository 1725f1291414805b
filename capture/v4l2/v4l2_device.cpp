#include "capture/v4l2/v4l2_device.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>

#include "core/error.h"

namespace stipple {
namespace {

std::string what_to_do_about(int error) {
    switch (error) {
        case EACCES:
        case EPERM:
            return "add yourself to the group video (sudo usermod -aG video $USER), then log in "
                   "again";
        case ENOENT:
        case ENODEV:
        case ENXIO:
            return "there is no such camera; \"stipple capture list\" shows those that there are";
        case EBUSY:
            return "another program uses it; close that first";
        case ENOTTY:
            return "this is not a video device";
        default:
            return "unplug and plug in the camera, then see what the kernel says: dmesg";
    }
}

template <std::size_t N>
std::string text_of(const __u8 (&field)[N]) {
    return {field, std::find(field, field + N, __u8{0})};
}

}  // namespace

std::string v4l2_node_path(const std::string& address) {
    constexpr std::string_view kPrefix = "v4l2:";
    std::string path =
        address.substr(0, kPrefix.size()) == kPrefix ? address.substr(kPrefix.size()) : address;
    const bool number = !path.empty() && std::all_of(path.begin(), path.end(), [](char c) {
        return std::isdigit(static_cast<unsigned char>(c)) != 0;
    });
    if (number) path.insert(0, "/dev/video");
    if (path.empty() || path.front() != '/')
        throw InputError(address, "name a node, as in v4l2:/dev/video0 or v4l2:0");
    return path;
}

V4l2Device::V4l2Device(std::string path) : path_(std::move(path)) {
    // O_CLOEXEC: a child process would keep the device busy.
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (descriptor_ < 0)
        throw DeviceError(address(), fmt::format("cannot open it: {}; {}", std::strerror(errno),
                                                 what_to_do_about(errno)));
    try {
        query();
    } catch (...) {
        ::close(descriptor_);
        throw;
    }
}

V4l2Device::~V4l2Device() {
    ::close(descriptor_);
}

void V4l2Device::query() {
    v4l2_capability capability{};
    demand(VIDIOC_QUERYCAP, &capability, "ask for its capabilities");
    const std::uint32_t able = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                   ? capability.device_caps
                                   : capability.capabilities;
    const bool single = (able & V4L2_CAP_VIDEO_CAPTURE) != 0;
    multi_planar_ = !single && (able & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0;
    if (!single && !multi_planar_)
        throw DeviceError(address(),
                          "this node captures no video; take another one of this camera "
                          "(\"stipple capture list\")");
    if ((able & V4L2_CAP_STREAMING) == 0)
        throw DeviceError(address(),
                          "its driver can only be read byte by byte, not streamed from; "
                          "it cannot be used");
    driver_ = text_of(capability.driver);
    card_ = text_of(capability.card);
    bus_ = text_of(capability.bus_info);
    version_ = fmt::format("{}.{}.{}", capability.version >> 16U, capability.version >> 8U & 0xFFU,
                           capability.version & 0xFFU);
}

std::uint32_t V4l2Device::buffer_type() const {
    return multi_planar_ ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
}

int V4l2Device::call(unsigned long request, void* argument) const noexcept {
    while (::ioctl(descriptor_, request, argument) != 0)
        if (errno != EINTR) return errno;
    return 0;
}

void V4l2Device::demand(unsigned long request, void* argument, std::string_view what) const {
    if (const int error = call(request, argument))
        throw DeviceError(address(), fmt::format("cannot {}: {}; {}", what, std::strerror(error),
                                                 what_to_do_about(error)));
}

V4l2Device::Readiness V4l2Device::wait_readable(std::chrono::milliseconds timeout) const noexcept {
    constexpr std::int64_t kMaxMs = std::numeric_limits<int>::max();
    pollfd waiting{descriptor_, POLLIN, 0};
    const auto at_most = std::clamp<std::int64_t>(timeout.count(), 0, kMaxMs);
    const int ready = ::poll(&waiting, 1, static_cast<int>(at_most));
    if (ready <= 0) return Readiness::kTimeout;  // or a signal: the caller looks at its clock
    constexpr unsigned kBroken = POLLERR | POLLHUP | POLLNVAL;
    return (static_cast<unsigned>(waiting.revents) & kBroken) != 0 ? Readiness::kError
                                                                   : Readiness::kReady;
}

}  // namespace stipple
