#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/geometry.h"

namespace stipple {

/// True if the extension is one of a video file.
[[nodiscard]] bool is_video_name(const std::filesystem::path& file);

/// Reads a video file frame by frame, as RGB of 8 bits a plane (deeper video is reduced to that).
class VideoReader {
  public:
    /// Decodes the first frame. \throws InputError if the file is missing, damaged or empty.
    explicit VideoReader(const std::filesystem::path& file);
    ~VideoReader();
    VideoReader(VideoReader&&) noexcept;
    VideoReader& operator=(VideoReader&&) noexcept;

    [[nodiscard]] FrameShape shape() const;
    /// Frames a second at which it plays, if it tells.
    [[nodiscard]] std::optional<double> film_hz() const;
    /// The file and the frame read last, for messages.
    [[nodiscard]] std::string place() const;

    /// The next frame, order (plane, row, col), scaled to 0..1; false at the end.
    /// \throws InputError if the video ends well before the frame its container announces.
    bool read(std::span<float> frame);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
