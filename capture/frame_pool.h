#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

namespace stipple {

/// Memory for the payloads of a number of frames. It is allocated in advance, and all of its pages
/// are written to, so that the resident memory of a program does not depend on how many frames
/// wait in its queues. Any thread may use it.
class FramePool {
  public:
    /// Makes memory for `frames` payloads of `bytes` bytes each. Called once.
    void reserve(std::size_t frames, std::size_t bytes);

    /// An empty payload with memory of the pool; if no more is left, without memory.
    [[nodiscard]] std::vector<std::uint8_t> take();
    /// Keeps the memory of a payload for a later one, but no more payloads than were reserved.
    void give_back(std::vector<std::uint8_t>&& payload);

    /// Number of payloads without memory so far.
    [[nodiscard]] std::uint64_t misses() const;

  private:
    mutable std::mutex mutex_;
    std::vector<std::vector<std::uint8_t>> free_;
    std::size_t frames_ = 0;
    std::size_t bytes_ = 0;  ///< of a payload
    std::uint64_t misses_ = 0;
};

}  // namespace stipple
