#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/colour_filter.h"
#include "core/flux_video.h"
#include "decoder/reconstruct.h"
#include "metrics/video_quality.h"
#include "readout/schedule_catalogue.h"

namespace stipple {

/// All frames of a clip of the footage folder, colour as luminance, light clipped at 2.0: what the
/// shortest exposure of the paper's sensor can hold. Nothing if the clip is absent.
[[nodiscard]] std::optional<FluxVideo> luminance_clip(const std::string& name);

/// The same in its three colours. Nothing if the clip is absent or has no colour.
[[nodiscard]] std::optional<FluxVideo> colour_clip(const std::string& name);

/// The schedule of config/schedules of this name, for an array of this shape.
[[nodiscard]] NamedSchedule schedule_of(const std::string& name, FrameShape shape);

/// Emulates the paper's sensor on `video` with a schedule of config/schedules and writes the sample
/// stream.
void write_recording(const FluxVideo& video, const std::string& schedule,
                     const std::filesystem::path& file);

void write_recording(const FluxVideo& video, const NamedSchedule& schedule, std::uint64_t seed,
                     const std::filesystem::path& file);

/// The same through a colour filter array, on a video in colour.
void write_mosaic(const FluxVideo& video, ColourFilter cfa, const NamedSchedule& schedule,
                  const std::filesystem::path& file);

[[nodiscard]] FluxVideo read_recording(const std::filesystem::path& file, DecodeMethod method);

/// Quality without the first and last 4 frames, light clipped at 2.0.
[[nodiscard]] VideoQuality quality_of(const FluxVideo& decoded, const FluxVideo& truth);

/// write_recording, read_recording through a temporary file, then the quality without the first
/// and last 4 frames.
[[nodiscard]] VideoQuality quality_of(const FluxVideo& video, const std::string& schedule,
                                      DecodeMethod method);
[[nodiscard]] VideoQuality quality_of(const FluxVideo& video, const NamedSchedule& schedule,
                                      std::uint64_t seed, DecodeMethod method);

}  // namespace stipple
