#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "capture/aravis/aravis_device.h"
#include "capture/camera.h"

namespace stipple {

/// If a USB3 Vision camera sends less than announced, the next leader or trailer is read into the
/// rest of the image. This function finds such packets in `buffer`, the memory of the incomplete
/// frame `frame_id`, and overwrites them with the pattern of `mark_unwritten`: the frame's own
/// trailer, or the leader of a later frame (USB3 Vision 1.0.1, 5.4: magic, size and id of the
/// frame).
void erase_usb_packets(std::span<std::uint8_t> buffer, std::uint64_t frame_id) noexcept;

/// The stream of a GenICam camera: buffers, received frames, losses.
class AravisStream {
  public:
    /// Makes stream and buffers. `device` must outlive the stream, and this program must control
    /// it. `packet_bytes` is the size of GigE packets with headers; default: the largest that the
    /// path carries. \throws DeviceError.
    AravisStream(AravisDevice& device, const FrameLayout& layout, const CameraBuffers& buffers,
                 std::optional<int> packet_bytes);
    ~AravisStream();
    AravisStream(const AravisStream&) = delete;
    AravisStream& operator=(const AravisStream&) = delete;

    [[nodiscard]] const FrameLayout& layout() const;
    [[nodiscard]] std::size_t buffer_bytes() const;  ///< of all buffers
    [[nodiscard]] TransportCounts counts() const;
    /// Sizes of packets and buffers, for CameraDescription.
    [[nodiscard]] std::map<std::string, std::string> facts() const;
    [[nodiscard]] std::vector<Message> warnings() const;

    void start();  ///< \throws DeviceError
    /// CLOCK_MONOTONIC just before the camera was told to begin.
    [[nodiscard]] std::int64_t started_ns() const;
    /// As Camera::wait; the payload is taken from `pool`.
    [[nodiscard]] Arrival wait(std::chrono::milliseconds timeout, FramePool& pool);
    void stop() noexcept;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
