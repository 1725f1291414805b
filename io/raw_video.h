#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "io/file_bytes.h"
#include "io/image.h"
#include "io/pixel_format.h"

namespace stipple {

/// Frames as a camera stores them: where they lie in a file, and the light of their numbers.
struct RawVideo {
    std::filesystem::path file;
    PixelFormat format;
    FrameShape shape;
    std::uint64_t slots = 0;
    std::uint64_t first_offset = 0;           ///< bytes before the first of frames in equal steps
    std::uint64_t stride = 0;                 ///< bytes of a step, at least a frame; 0: a frame
    std::vector<std::uint64_t> offsets = {};  ///< of each frame, if they have no equal steps
    std::vector<double> times = {};  ///< of each frame, in frame periods; empty: equal ones
    bool annotated = false;  ///< before each frame is a block that begins with its length (cine)
    bool bottom_up = false;  ///< the last row comes first
    std::vector<float> light_of_dn;
    SourceInfo traits = {};

    [[nodiscard]] std::uint64_t frame_bytes() const {
        return format.row_bytes(shape.cols) * static_cast<std::uint64_t>(shape.rows);
    }
};

/// Reads the frames of a raw video one after the other.
class RawVideoReader {
  public:
    /// \throws InputError if the file is unreadable or too short for the frames, or these are more
    /// than 2^31.
    explicit RawVideoReader(RawVideo video);

    [[nodiscard]] FrameShape shape() const { return video_.shape; }
    [[nodiscard]] int slots() const { return static_cast<int>(video_.slots); }
    [[nodiscard]] const SourceInfo& traits() const { return video_.traits; }
    [[nodiscard]] bool has_times() const { return !video_.times.empty(); }
    /// Of the frame read last, in frame periods. Precondition: has_times.
    [[nodiscard]] double frame_time() const { return video_.times[next_slot_ - 1]; }
    /// The file and the frame read last, for messages.
    [[nodiscard]] std::string where() const;

    /// The next frame, order (plane, row, col); false at the end. \throws InputError.
    bool read(std::span<float> frame);
    void skip(int frames) {
        next_slot_ = std::min(next_slot_ + static_cast<std::uint64_t>(frames), video_.slots);
    }

  private:
    /// Bytes from frame to frame, if they have equal steps.
    [[nodiscard]] std::uint64_t step() const {
        return video_.stride > 0 ? video_.stride : video_.frame_bytes();
    }
    [[nodiscard]] std::uint64_t offset_of(std::uint64_t slot);

    RawVideo video_;
    RandomAccessFile file_;
    std::uint64_t next_slot_ = 0;
    std::vector<std::uint8_t> bytes_;
    std::vector<std::uint16_t> samples_;  ///< of a row
};

}  // namespace stipple
