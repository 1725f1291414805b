#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "core/flux_video.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"
#include "readout/coded_sensor.h"
#include "sensor_model/colour_mosaic.h"

namespace stipple {

/// The noise of the sensor `paper`.
inline const SampleNoise& paper_noise() {
    static const SampleNoise noise(calibration_of({}));
    return noise;
}

/// A recording in memory.
struct Recorded {
    StreamHeader header;
    std::vector<SamplePacket> packets;
};

inline Recorded record(const FluxVideo& video, const ExposureSchedule& schedule,
                       SensorParams params = {}, std::uint64_t seed = 1) {
    params.charge_stores = schedule.charge_stores();
    Recorded recorded{{.shape = video.shape(),
                       .slot_us = 5000,
                       .calibration = calibration_of(params),
                       .schedule = schedule,
                       .schedule_source = {},
                       .schedule_name = "test",
                       .provenance = ""},
                      std::vector<SamplePacket>(static_cast<std::size_t>(video.slots()))};
    CodedSensor sensor(params, video.shape(), recorded.header.schedule, seed);
    for (int slot = 0; slot < video.slots(); ++slot)
        sensor.expose(video.frame(slot), recorded.packets[static_cast<std::size_t>(slot)]);
    return recorded;
}

/// The same through a colour filter array; the video has three planes.
inline Recorded record_mosaic(const FluxVideo& video, ColourFilter cfa,
                              const ExposureSchedule& schedule, const SensorParams& params = {}) {
    FluxVideo mosaic(video.slots(), {video.shape().rows, video.shape().cols, 1});
    for (int slot = 0; slot < video.slots(); ++slot)
        take_mosaic(cfa, video.shape(), video.frame(slot), mosaic.frame(slot));
    Recorded recorded = record(mosaic, schedule, params);
    recorded.header.cfa = cfa;
    return recorded;
}

inline VideoWindow whole(const FluxVideo& video) {
    return {.first_slot = 0,
            .slots = video.slots(),
            .first_row = 0,
            .first_col = 0,
            .shape = video.shape()};
}

inline Measurements measure(const FluxVideo& video, const ExposureSchedule& schedule,
                            const SensorParams& params = {}) {
    const Recorded recorded = record(video, schedule, params);
    return collect_measurements(recorded.header, recorded.packets, whole(video));
}

/// Evenly distributed values in [low, high), from a seed.
inline std::vector<float> random_values(std::size_t count, float low, float high,
                                        std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<float> values(count);
    for (float& value : values)
        value = low + (high - low) * static_cast<float>(random() >> 8U) * 0x1p-24F;
    return values;
}

inline FluxVideo random_video(int slots, FrameShape shape, std::uint32_t seed) {
    FluxVideo video(slots, shape);
    const auto values = random_values(video.voxels(), 0, 1, seed);
    std::copy(values.begin(), values.end(), video.data().begin());
    return video;
}

inline double dot(std::span<const float> a, std::span<const float> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return sum;
}

}  // namespace stipple
