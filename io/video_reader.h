#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/message.h"
#include "io/image.h"

namespace stipple {

/// True for the extension of a video file.
[[nodiscard]] bool is_video_name(const std::filesystem::path& file);

/// Reads a video file frame by frame, at its own bit depth, upright; grey as one plane, all others
/// as RGB (video_planes.h).
class VideoReader {
  public:
    /// Decodes the first frame. \throws InputError if the file is missing, damaged or empty, or its
    /// pixel format is unsupported.
    explicit VideoReader(const std::filesystem::path& file);
    ~VideoReader();
    VideoReader(VideoReader&&) noexcept;
    VideoReader& operator=(VideoReader&&) noexcept;

    [[nodiscard]] FrameShape shape() const;
    /// Playback rate in frames per second, if the file gives it.
    [[nodiscard]] std::optional<double> frames_hz() const;
    /// Number of frames by the container, which may be off by some.
    [[nodiscard]] std::optional<std::int64_t> announced_frames() const;
    [[nodiscard]] const SourceInfo& traits() const;
    /// Of the frame read last, as FrameTimes::time.
    [[nodiscard]] double frame_time() const;
    /// As FrameTimes::unequal, of the frames so far.
    [[nodiscard]] std::string unequal_times() const;
    /// Number of signs of damaged or missing frames so far.
    [[nodiscard]] std::vector<Message> warnings() const;
    /// The file and the last frame read, for messages.
    [[nodiscard]] std::string where() const;

    /// The next frame, order (plane, row, col), scaled to 0..1; false at the end.
    /// \throws InputError if the video is damaged here, or ends well before the frame that its
    /// container announces.
    bool read(std::span<float> frame);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
