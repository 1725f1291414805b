#pragma once

#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry.h"
#include "io/output_file.h"

namespace stipple {

/// Writes a float32 .npy video, (T,H,W) or (T,H,W,3), frame by frame. The header of an unfinished
/// file lacks at most the frames of the last second.
class NpyWriter {
  public:
    /// Creates `file`; messages name it `where`. The header has the comment. \throws DeviceError.
    NpyWriter(const std::filesystem::path& file, std::string_view where, FrameShape shape,
              std::string comment = {});

    /// `frame` holds shape.sites() floats, order (plane, row, col). \throws DeviceError.
    void write(std::span<const float> frame);
    /// Writes the number of frames and closes the file. \throws DeviceError.
    void finish();

  private:
    using Clock = std::chrono::steady_clock;
    void write_header();

    OutputFile file_;
    FrameShape shape_;
    std::string comment_;
    int slots_ = 0;
    int header_slots_ = 0;  ///< number of slots in the header
    Clock::time_point header_time_;
    std::vector<float> pixels_;  ///< by row, column and plane; empty before the first frame
};

}  // namespace stipple
