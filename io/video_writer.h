#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/geometry.h"
#include "io/frame_coding.h"
#include "io/lazy_ffmpeg.h"

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

/// Writes a video by FFmpeg's libraries, in limited range, with the same bits on any machine. Its
/// file declares curve, primaries and matrix. Odd sizes, and fewer than four columns, are padded by
/// repeating the last row or column.
///
/// For viewing: tone-mapped (io/tone_map.h), H.264 or uncompressed, of 8 bits, Y'CbCr by BT.709, in
/// .y4m below 720 rows by BT.601. In HDR: the signals of io/hdr_signal.h, HEVC or AV1 of 10 bits,
/// Y'CbCr by BT.2020 (non-constant luminance); in PQ with mastering display (SMPTE ST 2086) and
/// light levels (CTA-861.3), rounded up to cd/m2.
class VideoWriter {
  public:
    /// Creates `file` (.mp4, .mkv or .y4m), or opens a pipe for .y4m; messages name it `where`.
    /// \throws DeviceError.
    VideoWriter(const std::filesystem::path& file, std::string_view where, FrameShape shape,
                const VideoCoding& coding);
    ~VideoWriter();
    VideoWriter(VideoWriter&&) noexcept;
    VideoWriter& operator=(VideoWriter&&) noexcept;

    /// `frame` holds shape.sites() floats, order (plane, row, col). \throws DeviceError.
    void write(std::span<const float> frame);
    /// Completes the file. \throws DeviceError.
    void finish();
    /// Of the frames so far, in PQ.
    [[nodiscard]] std::optional<LightLevels> light_levels() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
