#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
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

/// When the frames of a video are shown, by their time stamps in ticks.
class FrameTimes {
  public:
    /// Times are in periods of the rate `hz`. Without a rate frame j is at j.
    explicit FrameTimes(double tick_s = 1, std::optional<double> hz = {});

    /// The next frame, with its time stamp if it has one.
    void add(std::optional<std::int64_t> tick);

    /// Of the last frame, from the first one on: its number, unless its time stamp differs from
    /// that by more than rounding.
    [[nodiscard]] double time() const { return time_; }
    /// "0.03 to 0.1 s apart"; empty if the frames are equally far apart but for rounding.
    [[nodiscard]] std::string unequal() const;

  private:
    double tick_s_;
    double ticks_a_period_;  ///< 0: unknown
    std::int64_t frames_ = 0;
    std::optional<double> origin_;  ///< tick of the first frame
    std::int64_t last_tick_ = 0;
    std::int64_t min_ticks_ = std::numeric_limits<std::int64_t>::max();  ///< between frames
    std::int64_t max_ticks_ = 0;
    double time_ = -1;
};

}  // namespace stipple
