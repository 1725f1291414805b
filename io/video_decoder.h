#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/message.h"

struct AVFrame;  // of FFmpeg's libavutil

namespace stipple {

/// Decodes the frames of a video file with FFmpeg's libraries, in display order. Nothing is
/// converted, and nothing is written to standard error.
class VideoDecoder {
  public:
    /// \throws InputError if the file is missing, is no video or has no decoder here.
    explicit VideoDecoder(const std::filesystem::path& file);
    ~VideoDecoder();
    VideoDecoder(VideoDecoder&&) noexcept;
    VideoDecoder& operator=(VideoDecoder&&) noexcept;

    /// The next frame, valid until the next call; null at the end, but not before the first frame.
    /// \throws InputError if the file is damaged there, if the frame is interlaced, or if the file
    /// ends well before the frame that its container announces.
    const AVFrame* next();

    /// Quarter turns, counter-clockwise, that rotate the frames upright: 0..3. \throws InputError
    /// if another angle or mirroring is necessary.
    [[nodiscard]] int quarter_turns() const;
    /// Playback rate in frames per second, if the file gives it.
    [[nodiscard]] std::optional<double> frames_hz() const;
    /// Of the last frame, as FrameTimes::time.
    [[nodiscard]] double frame_time() const;
    /// As VideoReader::announced_frames.
    [[nodiscard]] std::optional<std::int64_t> announced_frames() const;
    /// As FrameTimes::unequal, of the frames so far.
    [[nodiscard]] std::string unequal_times() const;
    /// Number of signs of damaged or missing frames so far.
    [[nodiscard]] std::vector<Message> warnings() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
