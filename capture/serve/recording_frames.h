#pragma once

#include <filesystem>
#include <optional>

#include "capture/recording/recording_reader.h"
#include "capture/serve/frame_source.h"

namespace stipple {

/// A recording as the frames of a camera again: the same bytes and device stamps. Frames that are
/// missing in it, or incomplete, are left out of the numbers, so that clients count them as lost.
class RecordingFrames final : public FrameSource {
  public:
    /// Without a rate, that of the stamps. \throws InputError as RecordingReader, if there is no
    /// complete frame, or if its format cannot go out over GigE Vision.
    explicit RecordingFrames(const std::filesystem::path& file,
                             std::optional<double> frames_per_s = {});

    [[nodiscard]] const ServedImage& image() const override { return image_; }
    void start(const PixelFormat& format) override;
    /// \throws InputError at a frame of another layout than the first.
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
