#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/arguments/run_options.h"
#include "core/flux_video.h"
#include "decoder/reconstruct.h"
#include "study/metrics/video_quality.h"
#include "study/report/run_report.h"
#include "study/scenes/scene.h"

namespace stipple {

/// Size of a stream.
struct StreamSize {
    double compression_ratio = 0;  ///< light values per sample
    std::uint64_t payload_bits = 0;
    double megabits_per_second = 0;  ///< of the sensor's time
};

/// All slots of a scene. \throws Interrupted.
[[nodiscard]] FluxVideo render_video(const Scene& scene, const RunOptions& run);

/// Emulates the default sensor with the named schedule; the stream goes to `file`.
/// \throws Interrupted, and as StreamRecorder.
StreamSize emulate_video(const FluxVideo& light, const std::string& schedule,
                         const std::filesystem::path& file, const RunOptions& run);

/// Decodes `file`, hands each frame to `take`, and compares it with `truth` (trial_quality of
/// explore/trial.h). \throws Interrupted, and as `decode` and `take`.
VideoQuality decode_and_compare(const std::filesystem::path& file, DecodeMethod method,
                                const FluxVideo& truth, const FrameSink& take,
                                const RunOptions& run);

/// The result of one way to record and decode a scene.
struct TrialResult {
    std::string name;
    std::string schedule;
    std::string text;  ///< description
    StreamSize size;
    VideoQuality quality;
};

/// For programs: an array with an entry per result.
[[nodiscard]] nlohmann::ordered_json trials_json(const std::vector<TrialResult>& results);

/// For people: a table with a line per result. Precondition: there is a result.
[[nodiscard]] std::string trials_table(const std::vector<TrialResult>& results);

/// Records and decodes `truth` in each way of the demo and leaves in `folder` the recordings, the
/// last way's video as `decoded/` (EXR) and `decoded.mp4`, and all ways side by side, for three
/// slots, as `side_by_side_1.png` ... The recordings and videos go into `report` too.
/// \throws Interrupted, InputError, DeviceError.
std::vector<TrialResult> run_trials(const FluxVideo& truth, const std::filesystem::path& folder,
                                    RunReport& report, const RunOptions& run);

}  // namespace stipple
