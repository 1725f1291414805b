#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct AVFrame;  // of FFmpeg's libavutil

namespace stipple {

/// Decodes the frames of a video file by FFmpeg's libraries, in the order in which they are shown.
/// Nothing is converted, and nothing is written to standard error.
class VideoDecoder {
  public:
    /// \throws InputError if the file is missing, is no video or has no decoder here.
    explicit VideoDecoder(const std::filesystem::path& file);
    ~VideoDecoder();
    VideoDecoder(VideoDecoder&&) noexcept;
    VideoDecoder& operator=(VideoDecoder&&) noexcept;

    /// The next frame, valid until the next call; null at the end, not before the first frame.
    /// \throws InputError if the file is damaged there, or ends well before the frame that its
    /// container announces.
    const AVFrame* next();

    /// Quarters of a turn, counter-clockwise, by which the frames are to be turned to be upright:
    /// 0..3. \throws InputError if they are to be turned by another angle or mirrored.
    [[nodiscard]] int quarter_turns() const;
    /// Frames a second at which the file plays, if it tells.
    [[nodiscard]] std::optional<double> film_hz() const;
    /// Signs, so far, that frames are damaged or missing.
    [[nodiscard]] std::vector<std::string> warnings() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
