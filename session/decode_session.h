#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry.h"
#include "core/message.h"
#include "core/progress.h"
#include "decoder/decode_cost.h"
#include "decoder/reconstruct.h"
#include "session/decode_setup.h"
#include "session/rig_folder.h"
#include "session/stream_calibration.h"

namespace stipple {

/// One decoding: a stream, or those of a rig, the calibration of each chip, and a method. Command,
/// Python and C++ programs decode with it:
///
///     DecodeSession session("clip.stipple", read_decode_setup("best", Config({})));
///     session.run([](std::int64_t slot, std::span<const float> light) { ... return true; });
///
/// What a rig's streams have in common is that of the first one.
class DecodeSession {
  public:
    /// Opens a stream, or the streams of the folder of a rig. \throws InputError as StreamReader,
    /// open_rig_folder and calibrate.
    DecodeSession(const std::filesystem::path& source, DecodeSetup setup,
                  const CalibrationChoice& calibration = {},
                  ReadPolicy policy = ReadPolicy::kTolerant);
    /// Of a stream or a rig that is open at its beginning; streams have the names of their files.
    DecodeSession(StreamReader stream, DecodeSetup setup,
                  const CalibrationChoice& calibration = {});
    DecodeSession(RigFolder rig, DecodeSetup setup, const CalibrationChoice& calibration = {});

    [[nodiscard]] std::deque<StreamReader>& streams() { return input_.readers; }
    [[nodiscard]] const std::deque<StreamReader>& streams() const { return input_.readers; }
    /// Of the frames.
    [[nodiscard]] FrameShape shape() const;
    /// Number of frames, if the stream knows its end.
    [[nodiscard]] std::optional<std::int64_t> frames() const;
    /// What is to be known before: chips that want a calibration, and have none.
    [[nodiscard]] const std::vector<Message>& warnings() const { return warnings_; }
    /// The slots that are computed for these frames: whole blocks. Known as frames() is.
    [[nodiscard]] std::optional<std::int64_t> computed_slots() const;
    [[nodiscard]] DecodeCost expected_cost(std::int64_t computed_slots);

    /// Ends after the first `frames` frames of the stream, which have the same bits as in the whole
    /// stream. Precondition: frames > 0.
    void end_after(std::int64_t frames) { end_ = frames; }
    /// Keeps the estimates of a method's stages.
    void keep_stages(StageSink stages) { setup_.options.stages = std::move(stages); }

    /// Decodes, once. The streams report damage. \throws as `decode_rig`; InputError without a
    /// frame, unless sink or progress have stopped it.
    DecodeReport run(
        const FrameSink& sink, const ProgressCallback& progress = [](double) { return true; });

  private:
    RigFolder input_;
    DecodeSetup setup_;
    std::vector<Message> warnings_;
    std::optional<std::int64_t> end_;
};

}  // namespace stipple
