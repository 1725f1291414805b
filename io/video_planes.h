#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/geometry.h"
#include "core/light.h"
#include "io/image.h"

struct AVFrame;  // of FFmpeg's libavutil

namespace stipple {

/// The transfer function of a code point of ITU-T H.273, as FFmpeg and PNG have them; none of those
/// that are not read.
[[nodiscard]] std::optional<Transfer> transfer_of_code(int code);

/// Converts the frames of a video to planes of numbers, 0..1 at the bit depth of the video: grey to
/// one plane, all others to red, green and blue. Y'CbCr is converted with the matrix and the range
/// that the frame declares (ITU-T H.273, 8.3). Without a declaration the matrix is BT.709 for 720
/// rows and more, else BT.601, as in video players, and the range is limited, for grey full.
/// Numbers beyond black and white are clipped.
class VideoPlanes {
  public:
    /// For frames like `first`, rotated by `quarter_turns` (0..3) counter-clockwise. \throws
    /// InputError at `name` if their format has no such numbers.
    VideoPlanes(const AVFrame& first, int quarter_turns, const std::string& name);
    ~VideoPlanes();
    VideoPlanes(VideoPlanes&&) noexcept;
    VideoPlanes& operator=(VideoPlanes&&) noexcept;

    [[nodiscard]] FrameShape shape() const;
    [[nodiscard]] const SourceInfo& traits() const;

    /// Order (plane, row, col), shape().sites() floats. False if the frame differs from the first
    /// in format.
    [[nodiscard]] bool convert(const AVFrame& frame, std::span<float> planes);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
