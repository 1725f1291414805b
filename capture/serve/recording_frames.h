#pragma once

#include <filesystem>
#include <optional>

#include "capture/recording/recording_reader.h"
#include "capture/serve/frame_source.h"

namespace stipple {

/// A recording as the frames of a camera, with the same bytes and device stamps. Frame numbers skip
/// missing and incomplete frames, so clients count them as lost.
class RecordingFrames final : public FrameSource {
  public:
    /// The default rate is that of the stamps. \throws InputError as RecordingReader, if there is
    /// no complete frame, or if GigE Vision has no such format.
    explicit RecordingFrames(const std::filesystem::path& file,
                             std::optional<double> frames_hz = {});

    [[nodiscard]] const ServedImage& image() const override { return image_; }
    void start(const PixelFormat& format) override;
    /// \throws InputError for a frame with another layout than the first.
    [[nodiscard]] std::optional<ServedFrame> next() override;

  private:
    [[nodiscard]] bool read_complete(CapturedFrame& frame);
    [[nodiscard]] double recorded_rate(const FrameRecord& first);

    std::filesystem::path file_;
    RecordingReader reader_;
    ServedImage image_;
    FrameLayout layout_;
    std::uint64_t first_id_ = 0;
};

}  // namespace stipple
