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

/// The brightest light that the default sensor can measure within a slot:
/// full_scale_e / photons_per_unit. Light is compared up to it.
inline constexpr double kBrightestLight = 2;

/// How its videos of `slots` frames are compared with the scene: without the first and last 4
/// frames (fewer of short clips), light up to kBrightestLight.
[[nodiscard]] QualityOptions demo_quality(int slots);

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

/// Decodes `file`, hands each frame to `take`, and compares it with `truth` (demo_quality). \throws
/// Interrupted, and as `decode` and `take`.
VideoQuality decode_and_compare(const std::filesystem::path& file, DecodeMethod method,
                                const FluxVideo& truth, const FrameSink& take,
                                const RunOptions& run);

}  // namespace stipple
