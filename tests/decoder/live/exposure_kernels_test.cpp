#include "decoder/live/exposure_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "decoder/measurements.h"
#include "readout/schedules/random_codes.h"
#include "tests/decoder/hand_made.h"
#include "tests/decoder/recordings.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

constexpr float kVariance = 1e-4F;  // of hand-made samples

LiveWindow whole_window(const Measurements& m) {
    return {.begin = 0, .core_begin = 0, .core_end = m.slots, .end = m.slots};
}

WindowRun run_of(const Measurements& m) {
    return {m, whole_window(m), {0, m.shape.sites()}};
}

std::vector<float> averaged(const Measurements& m) {
    std::vector<float> light(m.voxels());
    std::vector<std::uint8_t> known(m.shape.sites());
    average_in_time(run_of(m), light, known);
    return light;
}

TEST(AverageInTimeTest, LongExposuresCountByTheirSlotsAndDistance) {
    const auto x = averaged(hand_made(6, kSite,
                                      {{.first_slot = 0, .open_slots = 1, .light = 0.5F},
                                       {.first_slot = 1, .open_slots = 0b1111, .light = 4}}));
    // They end in slots 0 and 4.
    for (int slot = 0; slot < 6; ++slot) {
        const double a = std::exp(-slot / 16.0), b = 4 * std::exp(-std::abs(slot - 4) / 16.0);
        EXPECT_NEAR(x[static_cast<std::size_t>(slot)], (a * 0.5 + b * 1) / (a + b), 1e-6) << slot;
    }
}

TEST(AverageInTimeTest, MemoryIsShortWhereFewExposuresTell) {
    const auto x =
        averaged(hand_made(10, kSite,
                           {{.first_slot = 0, .open_slots = 1, .light = 1},
                            {.first_slot = 1, .open_slots = 0xFF, .light = 2, .saturated = true},
                            {.first_slot = 9, .open_slots = 1, .light = 2}}));
    const double memory =
        std::exp(-1 / 1.5) + (std::exp(-1 / 16.0) - std::exp(-1 / 1.5)) * 0.2 / 0.8;
    const double a = std::pow(memory, 2), b = std::pow(memory, 7);
    EXPECT_NEAR(x[2], (a * 1 + b * 2) / (a + b), 1e-6);
}

TEST(AverageInTimeTest, IsTheHighestBoundIfAllIsSaturated) {
    EXPECT_EQ(
        averaged(hand_made(4, kSite,
                           {{.first_slot = 0, .open_slots = 0b11, .light = 2, .saturated = true},
                            {.first_slot = 2, .open_slots = 1, .light = 2, .saturated = true}})),
        std::vector<float>(4, 2));
}

TEST(AverageInTimeTest, OmitsExposuresThatBeginBeforeTheWindow) {
    const Measurements m = hand_made(8, kSite,
                                     {{.first_slot = 1, .open_slots = 0b111, .light = 9},
                                      {.first_slot = 4, .open_slots = 1, .light = 1}});
    std::vector<float> light(6);
    std::vector<std::uint8_t> known(1);
    average_in_time({m, {.begin = 2, .core_begin = 4, .core_end = 6, .end = 8}, {0, 1}}, light,
                    known);
    EXPECT_EQ(light, std::vector<float>(6, 1));
    EXPECT_EQ(known[0], 2);
    average_in_time({m, {.begin = 2, .core_begin = 2, .core_end = 4, .end = 4}, {0, 1}}, light,
                    known);
    EXPECT_EQ(known[0], 0);
}

TEST(SpreadResidualsTest, EachOpenVoxelHasTheResidualOfItsExposure) {
    const Measurements m =
        hand_made(4, kSite, {{.first_slot = 0, .open_slots = 0b101, .light = 1.2F}});
    const std::vector<float> light{0.4F, 9, 0.6F, 9};
    std::vector<float> precision(4, -1), weighted(4, -1);
    spread_residuals(run_of(m), {.begin = 0, .end = 4}, light, {precision, weighted});
    // Of mean light 0.5, two slots.
    const double expected = 1 / (1e-4 / 4 + std::pow(0.11 * 0.5, 2));
    for (const std::size_t slot : {0U, 2U}) {
        EXPECT_NEAR(precision[slot], expected, 1e-4 * expected);
        EXPECT_NEAR(weighted[slot], 0.1 * expected, 1e-4 * expected);
    }
    for (const std::size_t slot : {1U, 3U}) EXPECT_EQ(precision[slot] + weighted[slot], 0);
}

TEST(SpreadResidualsTest, ABoundThatIsExceededTellsNothing) {
    const Measurements m =
        hand_made(2, kSite,
                  {{.first_slot = 0, .open_slots = 1, .light = 1, .saturated = true},
                   {.first_slot = 1, .open_slots = 1, .light = 1, .saturated = true}});
    std::vector<float> precision(2), weighted(2);
    spread_residuals(run_of(m), {.begin = 0, .end = 2}, std::vector<float>{1.5F, 0.5F},
                     {precision, weighted});
    EXPECT_EQ(precision[0], 0);
    EXPECT_NEAR(weighted[1], 0.5F / kVariance, 1e-3F / kVariance);
}

TEST(RestoreSumsTest, FollowASampleAsFarAsItIsBeyondNoise) {
    // r = 0.02, twice the noise: the gain is 4 / (4 + 3), and light moves in proportion to itself.
    const Measurements m =
        hand_made(2, kSite, {{.first_slot = 0, .open_slots = 0b11, .light = 0.62F}});
    const std::vector<float> light{0.4F, 0.2F};
    std::vector<float> x(2);
    restore_sums(run_of(m), light, x);
    EXPECT_NEAR(x[0], 0.4 + 0.02 * 4 / 7 * 0.401 / 0.602, 1e-5);
    EXPECT_NEAR(x[1], 0.2 + 0.02 * 4 / 7 * 0.201 / 0.602, 1e-5);
}

TEST(ExposureKernelsTest, GiveTheSameBitsOnAnySimdTarget) {
    const FrameShape shape{.rows = 9, .cols = 23, .planes = 1};
    const Measurements m =
        measure(random_video(24, shape, 1), random_schedule(9, 23, kPaperExposureSlots, 2));
    std::vector<float> first;
    for_each_simd_target([&](const std::string& target) {
        const WindowRun run = run_of(m);
        std::vector<float> light = averaged(m), x(m.voxels());
        std::vector<float> precision(m.voxels()), weighted(m.voxels());
        spread_residuals(run, {.begin = 0, .end = 24}, light, {precision, weighted});
        for (std::size_t i = 0; i < light.size(); ++i) light[i] += 1e-5F * weighted[i];
        restore_sums(run, light, x);
        if (first.empty()) first = x;
        EXPECT_EQ(x, first) << target;
    });
}

}  // namespace
}  // namespace stipple
