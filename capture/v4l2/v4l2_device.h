#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace stipple {

/// The node at "v4l2:/dev/video0" or "v4l2:0". \throws InputError for another address.
[[nodiscard]] std::string v4l2_node_path(const std::string& address);

/// An open V4L2 node (/dev/videoN), non-blocking; closed on destruction.
class V4l2Device {
  public:
    /// \throws DeviceError if it cannot be opened or is no video capture device with streaming; the
    /// message says what to do.
    explicit V4l2Device(std::string path);
    ~V4l2Device();
    V4l2Device(const V4l2Device&) = delete;
    V4l2Device& operator=(const V4l2Device&) = delete;

    /// ioctl, repeated if a signal interrupts it. \returns 0, or the errno of the failure
    [[nodiscard]] int call(unsigned long request, void* argument) const noexcept;
    /// `call` for requests that must succeed. \throws DeviceError "cannot <what>: <errno in words>"
    void demand(unsigned long request, void* argument, std::string_view what) const;

    enum class Readiness { kTimeout, kReady, kError };
    /// Waits until a frame can be fetched; kError is POLLERR or POLLHUP.
    [[nodiscard]] Readiness wait_readable(std::chrono::milliseconds timeout) const noexcept;

    [[nodiscard]] int descriptor() const { return descriptor_; }
    [[nodiscard]] const std::string& path() const { return path_; }
    /// "v4l2:/dev/video0", the place in messages.
    [[nodiscard]] std::string address() const { return "v4l2:" + path_; }
    [[nodiscard]] const std::string& driver() const { return driver_; }
    [[nodiscard]] const std::string& card() const { return card_; }
    [[nodiscard]] const std::string& bus() const { return bus_; }
    /// Version of the media subsystem of the kernel, "6.1.192".
    [[nodiscard]] const std::string& version() const { return version_; }
    /// Whether the node uses the multi-planar API, even if its formats have one plane.
    [[nodiscard]] bool multi_planar() const { return multi_planar_; }
    /// V4L2_BUF_TYPE_VIDEO_CAPTURE or V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE.
    [[nodiscard]] std::uint32_t buffer_type() const;

  private:
    void query();

    std::string path_;
    int descriptor_ = -1;
    std::string driver_;
    std::string card_;
    std::string bus_;
    std::string version_;
    bool multi_planar_ = false;
};

}  // namespace stipple
