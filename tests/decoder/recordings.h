#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/flux_video.h"
#include "sensor_model/sensor_params.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

class ExposureSchedule;
class SampleNoise;
struct Measurements;
struct VideoWindow;

/// A sensor without noise but rounding to 16 bits: 5e5 electrons at light 1, full at light 5 of one
/// slot.
[[nodiscard]] SensorParams rounding_sensor();

/// Light that is everywhere the same.
[[nodiscard]] FluxVideo flat_video(int slots, FrameShape shape, float light);

/// 16 slots in which bars of light 0.8 on 0.2 move a pixel a slot. Precondition: one plane.
[[nodiscard]] FluxVideo moving_bar(FrameShape shape);

/// The noise of the sensor `paper`.
[[nodiscard]] const SampleNoise& paper_noise();

/// A recording in memory.
struct Recorded {
    StreamHeader header;
    std::vector<SamplePacket> packets;
};

[[nodiscard]] Recorded record(const FluxVideo& video, const ExposureSchedule& schedule,
                              SensorParams params = {}, std::uint64_t seed = 1);

/// The same through a colour filter array; the video has three planes.
[[nodiscard]] Recorded record_mosaic(const FluxVideo& video, ColourFilter cfa,
                                     const ExposureSchedule& schedule,
                                     const SensorParams& params = {});

[[nodiscard]] VideoWindow whole(const FluxVideo& video);

[[nodiscard]] Measurements measure(const FluxVideo& video, const ExposureSchedule& schedule,
                                   const SensorParams& params = {});

/// Evenly distributed values in [low, high), from a seed.
[[nodiscard]] std::vector<float> random_values(std::size_t count, float low, float high,
                                               std::uint32_t seed);

[[nodiscard]] FluxVideo random_video(int slots, FrameShape shape, std::uint32_t seed);

[[nodiscard]] double dot(std::span<const float> a, std::span<const float> b);

/// Of a - b.
[[nodiscard]] double mean_square(std::span<const float> a, std::span<const float> b);

}  // namespace stipple
