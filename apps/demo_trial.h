#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "apps/arguments/run_options.h"
#include "core/flux_video.h"
#include "decoder/reconstruct.h"
#include "metrics/video_quality.h"
#include "scenes/scene.h"

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

}  // namespace stipple
