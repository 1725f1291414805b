#pragma once

#include <string>

#include "core/geometry.h"
#include "io/lazy_ffmpeg.h"
#include "io/video_coding.h"

struct AVStream;  // of FFmpeg's libavformat

namespace stipple {

/// An encoder for frames of this shape: H.264 of 8 bits, or HEVC or AV1 of 10 bits, Y'CbCr 4:2:0 in
/// limited range. It declares the curve, the primaries and the matrix. `global_header`: the file
/// has a place for the parameters of the stream. The same bits on any machine. \throws DeviceError
/// at `where` if FFmpeg has no such encoder, or it refuses the size or rate.
[[nodiscard]] FfmpegPtr<AVCodecContext> open_encoder(FrameShape shape, const VideoCoding& coding,
                                                     bool global_header, const std::string& where);

/// Light levels of a video that is not complete: no video of PQ has them, and they take two bytes
/// each.
inline constexpr unsigned kUnknownMaxCll = 0xFFFE;
inline constexpr unsigned kUnknownMaxFall = 0xFFFD;

/// PQ: declares to the stream's container the mastering display (SMPTE ST 2086) of coding.peak_cd,
/// and light levels, rounded up. \throws std::bad_alloc.
void declare_mastering_display(AVStream& stream, const VideoCoding& coding);
void declare_light_levels(AVStream& stream, unsigned max_cll, unsigned max_fall);

}  // namespace stipple
