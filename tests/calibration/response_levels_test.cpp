#include "calibration/response_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "calibration/field_samples.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 16, .cols = 16, .planes = 1};

StreamHeader header_of(double slot_us) {
    return {.shape = kShape,
            .slot_us = slot_us,
            .calibration = {.bit_depth = 16, .gain_e_per_dn = 1, .full_well_e = 1e6},
            .schedule = {1, 1, 1, {0, 1}, {{0, 1}}},
            .schedule_source = {},
            .schedule_name = "",
            .provenance = ""};
}

/// Samples 500 + 100 t / s + light t, 20 frames with noise of 3 DN; two pixels are hot and dead.
void expose(double slot_us, double light_dn_per_s, FieldSamples& field) {
    std::mt19937 random(static_cast<std::uint32_t>(slot_us));
    std::normal_distribution<double> noise(0, 3);
    const StreamHeader header = header_of(slot_us);
    FieldCollector collector(header, field);
    for (int frame = 0; frame < 20; ++frame) {
        SamplePacket packet{.slot = frame, .rows = kShape.rows, .dn = {}};
        for (std::size_t i = 0; i < kShape.sites(); ++i) {
            const double light = i == 7 ? 0 : light_dn_per_s, dark = i == 9 ? 60000 : 100;
            packet.dn.push_back(static_cast<std::uint16_t>(
                std::lround(500 + slot_us * 1e-6 * (dark + light) + noise(random))));
        }
        collector.add(packet);
    }
}

std::vector<FieldExposure> exposures_of(const FieldSamples& field) {
    std::vector<FieldExposure> exposures;
    for (const auto& [time, sums] : field.exposures())
        exposures.push_back(field_exposure(time, sums, header_of(1000)));
    return exposures;
}

TEST(ResponseLevelsTest, AreMeansOfSoundPixelsByExposure) {
    FieldSamples dark(kShape), flat(kShape);
    expose(5000, 0, dark);
    expose(80000, 0, dark);
    for (const double slot_us : {2000.0, 4000.0, 9000.0}) expose(slot_us, 1e6, flat);
    const auto levels =
        response_levels(header_of(1000), exposures_of(dark), exposures_of(flat), {.number = 2});
    ASSERT_EQ(levels.size(), 3U);
    // 3 DN of 254 pixels and 20 frames, five standard deviations.
    const double tolerance = 5 * 3 / std::sqrt(254 * 20.0);
    for (const ResponseLevel& level : levels) {
        EXPECT_NEAR(level.dark_dn, 500 + 100 * level.exposure, tolerance);
        EXPECT_NEAR(level.mean_dn, 500 + 1000100 * level.exposure, tolerance);
        EXPECT_NEAR(level.noise_dn2, 9 + 1.0 / 12, 9 * 5 * std::sqrt(2 / (254 * 19.0)));
        EXPECT_NEAR(std::sqrt(level.variance_dn2) * 5, tolerance, 0.1 * tolerance);
        EXPECT_EQ(level.scale, levels.front().scale);
    }
    EXPECT_DOUBLE_EQ(levels[0].exposure, 0.002);
    EXPECT_DOUBLE_EQ(levels[2].exposure, 0.009);
}

TEST(ResponseLevelsTest, LevelsThatClipAreLeftOut) {
    std::vector<ResponseLevel> levels;
    for (std::size_t scale = 0; scale < 2; ++scale)
        for (int i = 5; i >= 1; --i)
            levels.push_back({.scale = scale,
                              .exposure = static_cast<double>(i),
                              .noise_dn2 = i == 4 && scale == 0 ? 1.0 : 10.0 * i});
    leave_out_clipped(levels);
    ASSERT_EQ(levels.size(), 7U);  // of scale 0: 3 may clip in part, 4 does, 5 is brighter
    EXPECT_EQ(levels[1].exposure, 2);
    EXPECT_EQ(levels[2].scale, 1U);
}

}  // namespace
}  // namespace stipple
