// Pixels that differ and have dark current: the calibration tile of the stream undoes what the chip
// did.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "decoder/fast/motion_tv.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "decoder/pixel_response.h"
#include "decoder/sampling_operator.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 12, .cols = 10, .planes = 3};
constexpr float kLight = 0.3F;

/// A neutral-density mosaic with dual gain and dark current; without noise, if it is to have none.
SensorParams mosaic(bool noise) {
    return {.photons_per_unit = 20000,
            .full_scale_e = 65535,
            .full_well_e = 1e6,
            .read_noise_e = noise ? 100.0 : 0.0,
            .shot_noise = noise,
            .bit_depth = 16,
            .mode = SensorMode::kPhysical,
            .physical = {.quantum_efficiency = 0.5,
                         .dark_current_e_per_s = 4000,
                         .temperature_c = 28,
                         .black_level_dn = noise ? 500.0 : 30.0,
                         .map_rows = 2,
                         .map_cols = 3,
                         .transmittance = {1, 0.5, 0.25, 0.125, 1, 1},
                         .gain_map = {1, 2, 1, 4, 1, 0.5}}};
}

FluxVideo flat(int slots) {
    FluxVideo video(slots, kShape);
    std::ranges::fill(video.data(), kLight);
    return video;
}

VideoWindow window(int slots) {
    return {0, slots, 0, 0, kShape};
}

TEST(PixelCalibrationTest, AFlatSceneWithoutNoiseDecodesToItsLight) {
    for (const auto& schedule :
         {random_schedule(12, 10, kPaperExposureSlots, 1), gapped_schedule(3, 5, 29, 2)}) {
        const Recorded recorded = record(flat(40), schedule, mosaic(false));
        Measurements m = collect_measurements(recorded.header, recorded.packets, window(40));
        std::size_t samples = 0;
        for (std::size_t i = 0; i < m.voxels(); ++i) {
            if ((m.state[i] & Measurements::kLast) == 0) continue;
            ++samples;
            // An exposure of n slots holds n times the light. Half a DN of 1 e, at the least
            // responsive pixel (1250 e per unit at gain 4, 2500 at 1): 2.1e-4.
            const auto slots = static_cast<double>(std::round(m.sum[i] / kLight));
            EXPECT_NEAR(m.sum[i], slots * static_cast<double>(kLight), 2.1e-4);
            EXPECT_GE(slots, 1);
        }
        EXPECT_GT(samples, 500U);
        if (!schedule.gapless()) continue;  // some pixels are never read
        const FluxVideo naive = nearest_samples(m);
        for (const float light : naive.data()) EXPECT_NEAR(light, kLight, 2.1e-4);
    }
}

TEST(PixelCalibrationTest, TotalVariationDecodesAFlatSceneToItsLight) {
    const Recorded recorded =
        record(flat(30), random_schedule(12, 10, kPaperExposureSlots, 1), mosaic(false));
    Measurements m = collect_measurements(recorded.header, recorded.packets, window(30));
    const FluxVideo x = *decode_motion_tv(m, SampleNoise(recorded.header.calibration), {});
    for (const float light : x.data()) EXPECT_NEAR(light, kLight, 1e-3);
}

TEST(PixelCalibrationTest, VariancesAreThoseOfTheSamples) {
    // Many slots of a flat scene: the scatter of each tile pixel's samples against its variance.
    const int slots = 400;
    const ExposureSchedule schedule(1, 1, 2, {0, 1}, {{0, 0b11}});
    const Recorded recorded = record(flat(slots), schedule, mosaic(true));
    Measurements m = collect_measurements(recorded.header, recorded.packets, window(slots));
    refresh_variances(m, SampleNoise(recorded.header.calibration), flat(slots).data());
    double scatter[6] = {}, predicted[6] = {}, samples[6] = {};
    for (std::size_t i = 0; i < m.voxels(); ++i) {
        if ((m.state[i] & Measurements::kLast) == 0) continue;
        const std::size_t pixel = i % kShape.pixels();
        const std::size_t tile = pixel / 10 % 2 * 3 + pixel % 10 % 3;
        scatter[tile] += std::pow(static_cast<double>(m.sum[i]) - 2 * 0.3, 2);
        predicted[tile] += static_cast<double>(m.variance[i]);
        samples[tile] += 1;
    }
    // At least 200 exposures of 3 planes of 18 pixels: 10800 samples, 5 sqrt(2 / n) = 7 %.
    for (int tile = 0; tile < 6; ++tile) {
        EXPECT_GE(samples[tile], 10800);
        EXPECT_NEAR(scatter[tile] / predicted[tile], 1, 0.07) << tile;
    }
}

TEST(PixelCalibrationTest, TellsThePixelsThatAreSaturated) {
    SensorParams params = mosaic(false);
    params.full_well_e = 1500;
    FluxVideo video = flat(4);
    const ExposureSchedule schedule(1, 1, 1, {0, 1}, {{0, 1}});
    const Recorded recorded = record(video, schedule, params);
    const Measurements m = collect_measurements(recorded.header, recorded.packets, window(4));
    // 10000 e per unit x 0.3 = 3000 e at transmittance 1, 1500 at 1/2, 750 at 1/4, 375 at 1/8; and
    // 40 dark electrons.
    const bool saturated[6] = {true, true, false, false, true, true};
    for (std::size_t pixel = 0; pixel < kShape.pixels(); ++pixel)
        EXPECT_EQ((m.state[pixel] & Measurements::kSaturated) != 0,
                  saturated[pixel / 10 % 2 * 3 + pixel % 10 % 3])
            << pixel;
}

}  // namespace
}  // namespace stipple
