#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/colour_filter.h"
#include "core/flux_video.h"
#include "decoder/decode_options.h"
#include "decoder/reconstruct.h"
#include "readout/schedules/named_schedule.h"
#include "sensor_model/sensor_params.h"
#include "stream/stream_header.h"
#include "study/metrics/video_quality.h"

namespace stipple {

/// All frames of a clip of the footage folder, colour as luminance, light clipped at 2.0: what the
/// shortest exposure of the paper's sensor can hold. Nothing if the clip is absent, or an error as
/// of footage_clip.
[[nodiscard]] std::optional<FluxVideo> luminance_clip(const std::string& name);

/// The same in its three colours. Nothing if the clip is absent or has no colour.
[[nodiscard]] std::optional<FluxVideo> colour_clip(const std::string& name);

/// The first `slots` slots of the `side` x `side` pixels in the middle, or what there is of them;
/// the video has one plane.
[[nodiscard]] FluxVideo middle(const FluxVideo& video, int side, int slots);

/// The schedule of config/schedules of this name, for an array of this shape.
[[nodiscard]] NamedSchedule schedule_of(const std::string& name, FrameShape shape);

/// Emulates the paper's sensor on `video` with a schedule of config/schedules and writes the sample
/// stream.
void write_recording(const FluxVideo& video, const std::string& schedule,
                     const std::filesystem::path& file);

void write_recording(const FluxVideo& video, const NamedSchedule& schedule, std::uint64_t seed,
                     const std::filesystem::path& file);

/// The sensor of config/sensors of this name, with "key=value" on top, and the photons of light 1.0
/// times `light`: the same footage in more or less light.
[[nodiscard]] SensorParams sensor_of(const std::string& name,
                                     const std::vector<std::string>& settings = {},
                                     double light = 1);

/// The light that clips a sample of one slot, by the converter or the full well.
[[nodiscard]] double clipping_light(const SensorParams& sensor);

/// As above, on any sensor.
void write_recording(const FluxVideo& video, const NamedSchedule& schedule,
                     const SensorParams& sensor, const std::filesystem::path& file);

/// The same through a colour filter array, on a video in colour.
void write_mosaic(const FluxVideo& video, ColourFilter cfa, const NamedSchedule& schedule,
                  const std::filesystem::path& file);

/// Defaults; those of `learned` and `learned_fast` with the weights of Stipple.
[[nodiscard]] DecodeOptions options_of(DecodeMethod method);

/// Decoded with this calibration of the sites, if there is one, and this response.
[[nodiscard]] FluxVideo read_recording(const std::filesystem::path& file, DecodeMethod method,
                                       std::vector<SiteCalibration> sites = {},
                                       ResponseTable response = {});

/// Quality without the first and last 4 frames, light clipped at 2.0.
[[nodiscard]] VideoQuality quality_of(const FluxVideo& decoded, const FluxVideo& truth);

/// write_recording, read_recording through a temporary file, then the quality without the first
/// and last 4 frames.
[[nodiscard]] VideoQuality quality_of(const FluxVideo& video, const std::string& schedule,
                                      DecodeMethod method);
[[nodiscard]] VideoQuality quality_of(const FluxVideo& video, const NamedSchedule& schedule,
                                      std::uint64_t seed, DecodeMethod method);

}  // namespace stipple
