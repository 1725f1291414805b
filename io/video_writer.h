#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "core/geometry.h"

namespace stipple {

/// Writes a video for viewing: tone-mapped (io/tone_map.h), H.264 of 8 bits by FFmpeg's libraries,
/// Y'CbCr by BT.709 in limited range, which the file declares. Odd sizes, and fewer than four
/// columns, are padded by repeating the last row or column. The same bits on any machine.
class VideoWriter {
  public:
    /// Creates `file` (.mp4 or .mkv); messages name it `where`. \throws DeviceError.
    VideoWriter(const std::filesystem::path& file, std::string_view where, FrameShape shape,
                double frames_per_second);
    ~VideoWriter();
    VideoWriter(VideoWriter&&) noexcept;
    VideoWriter& operator=(VideoWriter&&) noexcept;

    /// `frame` holds shape.sites() floats, order (plane, row, col). \throws DeviceError.
    void write(std::span<const float> frame);
    /// Completes the file. \throws DeviceError.
    void finish();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
