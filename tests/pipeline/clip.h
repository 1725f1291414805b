#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/flux_video.h"
#include "decoder/reconstruct.h"
#include "metrics/video_quality.h"
#include "readout/schedule_catalogue.h"

namespace stipple {

/// All frames of a clip of the footage folder, colour as luminance, light clipped at 2.0: what the
/// shortest exposure of the paper's sensor can hold. Nothing if the clip is absent.
[[nodiscard]] std::optional<FluxVideo> luminance_clip(const std::string& name);

/// Emulates the paper's sensor on `video` with a schedule of config/schedules and writes the sample
/// stream.
void write_recording(const FluxVideo& video, const std::string& schedule,
                     const std::filesystem::path& file);

void write_recording(const FluxVideo& video, const NamedSchedule& schedule, std::uint64_t seed,
                     const std::filesystem::path& file);

[[nodiscard]] FluxVideo read_recording(const std::filesystem::path& file, DecodeMethod method);

/// write_recording, read_recording through a temporary file, then the quality without the first
/// and last 4 frames.
[[nodiscard]] VideoQuality quality_of(const FluxVideo& video, const std::string& schedule,
                                      DecodeMethod method);
[[nodiscard]] VideoQuality quality_of(const FluxVideo& video, const NamedSchedule& schedule,
                                      std::uint64_t seed, DecodeMethod method);

}  // namespace stipple
