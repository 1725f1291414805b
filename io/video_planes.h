#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/geometry.h"
#include "io/picture.h"

struct AVFrame;  // of FFmpeg's libavutil

namespace stipple {

/// Turns the frames of a video into planes of numbers, 0..1 at the depth of the video: grey into
/// one plane, all others into red, green and blue. Y'CbCr is converted by the matrix and the range
/// that the frame declares (ITU-T H.273, 8.3): where it declares none by BT.709 from 720 rows on,
/// else by BT.601, as players do, and from limited range; grey from full range. Numbers beyond
/// black and white are clipped to them.
class VideoPlanes {
  public:
    /// For frames like `first`, which are to be turned by `quarter_turns` (0..3) counter-clockwise.
    /// \throws InputError at `name` if they are of a format that has no such numbers.
    VideoPlanes(const AVFrame& first, int quarter_turns, const std::string& name);
    ~VideoPlanes();
    VideoPlanes(VideoPlanes&&) noexcept;
    VideoPlanes& operator=(VideoPlanes&&) noexcept;

    [[nodiscard]] FrameShape shape() const;
    [[nodiscard]] const SourceTraits& traits() const;

    /// Order (plane, row, col), shape().sites() floats. False if the frame is not like the first.
    [[nodiscard]] bool convert(const AVFrame& frame, std::span<float> planes);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
