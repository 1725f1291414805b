#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace stipple {

/// Plays frames of known contents into a V4L2 output, over and over, until it is destroyed: the
/// other end of vivid's loop. It speaks to the driver by itself, so that it shares no mistake with
/// V4l2Camera.
class LoopWriter {
  public:
    /// \throws std::runtime_error if the driver does not take this format, or frames of this size
    LoopWriter(const std::string& node, std::uint32_t fourcc, int width, int height,
               std::vector<std::vector<std::uint8_t>> frames);
    ~LoopWriter();
    LoopWriter(const LoopWriter&) = delete;
    LoopWriter& operator=(const LoopWriter&) = delete;

  private:
    void play();
    [[nodiscard]] bool put(std::uint32_t index, std::size_t frame);

    std::vector<std::vector<std::uint8_t>> frames_;
    int descriptor_ = -1;
    std::vector<std::span<std::uint8_t>> buffers_;
    std::atomic<bool> stop_ = false;
    std::jthread thread_;
};

}  // namespace stipple
