#include "tests/decoder/recordings.h"

#include <algorithm>
#include <random>

#include "decoder/measurements.h"
#include "decoder/pixel_response.h"
#include "readout/emulator.h"
#include "sensor_model/slot_light.h"

namespace stipple {

FluxVideo moving_bar(FrameShape shape) {
    FluxVideo video(16, shape);
    for (int slot = 0; slot < video.slots(); ++slot)
        for (int row = 0; row < shape.rows; ++row)
            for (int col = 0; col < shape.cols; ++col)
                video.plane(slot, 0)(row, col) = (col - slot + 32) % 16 < 6 ? 0.8F : 0.2F;
    return video;
}

const SampleNoise& paper_noise() {
    static const SampleNoise noise(calibration_of({}));
    return noise;
}

Recorded record(const FluxVideo& video, const ExposureSchedule& schedule, SensorParams params,
                std::uint64_t seed) {
    params.charge_stores = schedule.charge_stores();
    const SensorSetup setup{
        .params = params,
        .schedule = NamedSchedule{.name = "test", .source = {}, .schedule = schedule},
        .shape = video.shape(),
        .footage = video.shape(),
        .seed = seed};
    Recorded recorded{stream_header_of(setup, ""), {}};
    Emulator emulator(setup);
    for (int slot = 0; slot < video.slots(); ++slot)
        for (const SamplePacket& packet : emulator.expose(video.frame(slot)))
            recorded.packets.push_back(packet);
    return recorded;
}

Recorded record_mosaic(const FluxVideo& video, ColourFilter cfa, const ExposureSchedule& schedule,
                       const SensorParams& params) {
    FluxVideo mosaic(video.slots(), {video.shape().rows, video.shape().cols, 1});
    for (int slot = 0; slot < video.slots(); ++slot)
        take_mosaic(cfa, video.shape(), video.frame(slot), mosaic.frame(slot));
    Recorded recorded = record(mosaic, schedule, params);
    recorded.header.cfa = cfa;
    return recorded;
}

VideoWindow whole(const FluxVideo& video) {
    return {.first_slot = 0,
            .slots = video.slots(),
            .first_row = 0,
            .first_col = 0,
            .shape = video.shape()};
}

Measurements measure(const FluxVideo& video, const ExposureSchedule& schedule,
                     const SensorParams& params) {
    const Recorded recorded = record(video, schedule, params);
    return collect_measurements(recorded.header, recorded.packets, whole(video));
}

std::vector<float> random_values(std::size_t count, float low, float high, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<float> values(count);
    for (float& value : values)
        value = low + (high - low) * static_cast<float>(random() >> 8U) * 0x1p-24F;
    return values;
}

FluxVideo random_video(int slots, FrameShape shape, std::uint32_t seed) {
    FluxVideo video(slots, shape);
    const auto values = random_values(video.voxels(), 0, 1, seed);
    std::copy(values.begin(), values.end(), video.data().begin());
    return video;
}

double dot(std::span<const float> a, std::span<const float> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return sum;
}

SensorParams rounding_sensor() {
    SensorParams params;
    params.shot_noise = false;
    params.read_noise_e = 0;
    params.photons_per_unit = 5e5;
    params.full_scale_e = params.full_well_e = 2.5e6;
    params.bit_depth = 16;
    return params;
}

FluxVideo flat_video(int slots, FrameShape shape, float light) {
    FluxVideo video(slots, shape);
    std::ranges::fill(video.data(), light);
    return video;
}

double mean_square(std::span<const float> a, std::span<const float> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = static_cast<double>(a[i]) - static_cast<double>(b[i]);
        sum += difference * difference;
    }
    return sum / static_cast<double>(a.size());
}

}  // namespace stipple
