#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "capture/camera.h"
#include "capture/recording/recording_reader.h"
#include "io/footage_reader.h"

namespace stipple {

/// Frames to play back, one after the other: of a recording as they are, or of footage as the
/// numbers round(min(light, 1) x full scale) of a pixel format.
class ReplaySource {
  public:
    /// Opens a recording, or else footage that shall come in `format` ("Mono8" or "Mono16", of
    /// colour "RGB8" or "BayerRG8" ... "BayerBG16"; empty: Mono16 or RGB8). \throws InputError if
    /// it is neither, holds no frame, or for a format that it cannot come in.
    ReplaySource(const std::filesystem::path& path, const std::string& format);

    [[nodiscard]] bool is_recording() const { return recording_.has_value(); }
    [[nodiscard]] const SessionRecord* session() const;
    /// The layout of the first frame.
    [[nodiscard]] const FrameLayout& layout() const { return layout_; }

    /// The next frame; of footage, id counts from 0. False at the end. \throws InputError.
    bool next(CapturedFrame& frame);
    void rewind();
    /// Where footage may not be what it seems, and what of its first frame its format cannot hold.
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
    /// What reading to the end has shown to be wrong besides; empty if nothing is.
    [[nodiscard]] std::string end_warning();

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
    std::vector<std::string> warnings_;
};

}  // namespace stipple
