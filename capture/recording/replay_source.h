#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "capture/camera.h"
#include "capture/recording/recording_reader.h"
#include "core/message.h"
#include "io/footage_reader.h"

namespace stipple {

/// Frames for a replay: those of a recording unchanged, or footage as the numbers
/// round(min(light, 1) x full scale) of a pixel format.
class ReplaySource {
  public:
    /// Opens a recording, or footage for the pixel format `format` ("Mono8" or "Mono16", in colour
    /// "RGB8" or "BayerRG8" ... "BayerBG16"; empty: Mono16, RGB8, or of the mosaic of a colour
    /// filter array its own of 16 bits). \throws InputError if it is neither, holds no frame, or
    /// does not suit the format.
    ReplaySource(const std::filesystem::path& path, const std::string& format);

    [[nodiscard]] bool is_recording() const { return recording_.has_value(); }
    [[nodiscard]] const SessionRecord* session() const;
    /// The layout of the first frame.
    [[nodiscard]] const FrameLayout& layout() const { return layout_; }

    /// The next frame; ids of footage count from 0. False at the end. \throws InputError.
    bool next(CapturedFrame& frame);
    void rewind();
    /// Warnings on the footage, and on clipping of its first frame.
    [[nodiscard]] const std::vector<Message>& warnings() const { return warnings_; }
    /// Further faults that were found up to the end; empty if there are none.
    [[nodiscard]] Message end_warning();

  private:
    void open_footage();
    void look_at_first_frame();
    void quantise(std::vector<std::uint8_t>& payload) const;

    std::filesystem::path path_;
    std::optional<RecordingReader> recording_;
    std::optional<FootageReader> footage_;
    FrameLayout layout_;
    std::vector<float> light_;
    std::uint64_t next_id_ = 0;
    std::vector<Message> warnings_;
};

}  // namespace stipple
