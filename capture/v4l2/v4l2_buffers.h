#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/v4l2/v4l2_device.h"

namespace stipple {

/// Owner of the frame memory.
enum class V4l2Memory {
    kDriver,  ///< the driver's, mapped by us (V4L2_MEMORY_MMAP)
    kOwn,     ///< ours (V4L2_MEMORY_USERPTR)
};

/// The frame buffers that a V4L2 driver and this program exchange. A buffer is either queued with
/// the driver or ours.
class V4l2Buffers {
  public:
    /// A buffer that the driver filled.
    struct Filled {
        int index = 0;
        std::span<const std::uint8_t> bytes;  ///< written, as the driver says
        std::uint32_t sequence = 0;
        std::uint32_t flags = 0;    ///< V4L2_BUF_FLAG_...
        std::int64_t stamp_ns = 0;  ///< on the clock that `flags` name
        bool overflow = false;      ///< the driver claims more bytes than the buffer has
    };

    /// \throws DeviceError if the driver provides no such buffers, or fewer than two.
    V4l2Buffers(const V4l2Device& device, V4l2Memory memory, int frames, std::size_t frame_bytes);
    ~V4l2Buffers();
    V4l2Buffers(const V4l2Buffers&) = delete;
    V4l2Buffers& operator=(const V4l2Buffers&) = delete;

    [[nodiscard]] int count() const { return static_cast<int>(places_.size()); }
    /// Number of buffers queued with the driver.
    [[nodiscard]] int queued() const { return queued_; }

    /// Queues all buffers that are ours with the driver. A driver may refuse one temporarily
    /// (EINVAL): it stays ours, and the next call tries again. \returns 0 or the last errno
    int queue_all() noexcept;
    /// Fetches the next filled buffer without waiting. \returns 0, EAGAIN if none is filled yet,
    /// or the errno of the failure
    [[nodiscard]] int fetch(Filled& filled) noexcept;
    /// Ends the use of a fetched buffer.
    void release(int index) noexcept { places_[static_cast<std::size_t>(index)].held = false; }
    /// To be called after the stream of the driver was stopped, which returns all buffers to us.
    void all_ours() noexcept;

  private:
    struct Place {
        std::span<std::uint8_t> memory;
        bool queued = false;
        bool held = false;  ///< the frame in it is still being read
    };

    void map(std::size_t index);
    void allocate(std::size_t index, std::size_t bytes);
    void free_all() noexcept;
    [[nodiscard]] int queue(std::size_t index) noexcept;

    const V4l2Device& device_;
    V4l2Memory memory_;
    std::vector<Place> places_;
    int queued_ = 0;
};

}  // namespace stipple
