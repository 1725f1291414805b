#include "calibration/field_samples.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

/// One row of two pixels of 10 bits: the left one is exposed in every slot of 5 ms, the right one
/// for two slots. Slots 0, 2, ... hold the left pixel, the others both.
StreamHeader two_pixels() {
    return {.shape = {.rows = 1, .cols = 2, .planes = 1},
            .slot_us = 5000,
            .calibration = {.bit_depth = 10, .black_level_dn = 64, .gain_e_per_dn = 20},
            .schedule = {1, 2, 2, {0, 2, 3}, {{0, 1}, {1, 1}, {0, 3}}},
            .schedule_source = {},
            .schedule_name = "",
            .provenance = ""};
}

TEST(FieldSamplesTest, SumsAreThoseOfEachExposureTime) {
    const StreamHeader header = two_pixels();
    FieldSamples field(header.shape);
    FieldCollector collector(header, field);
    collector.add({.slot = 0, .rows = 1, .dn = {100}});
    collector.add({.slot = 1, .rows = 1, .dn = {110, 300}});
    collector.add({.slot = 2, .rows = 1, .dn = {0}});
    collector.add({.slot = 3, .rows = 1, .dn = {90, 1023}});
    ASSERT_EQ(field.exposures().size(), 2U);
    const ExposureSums& one = field.exposures().at(5000000);
    EXPECT_EQ(one.count, (std::vector<std::uint32_t>{4, 0}));
    EXPECT_EQ(one.sum[0], 300U);
    EXPECT_DOUBLE_EQ(one.mean(0), 75);
    EXPECT_DOUBLE_EQ(one.variance(0), (25 * 25 + 35 * 35 + 75 * 75 + 15 * 15) / 3.0);
    EXPECT_EQ(one.zeros, 1U);
    EXPECT_EQ(one.saturated, 0U);
    const ExposureSums& two = field.exposures().at(10000000);
    EXPECT_EQ(two.count, (std::vector<std::uint32_t>{0, 2}));
    EXPECT_EQ(two.saturated, 1U);
    EXPECT_EQ(two.samples, 2U);
    EXPECT_EQ(field.fewest(), 2U);
}

// The left pixel has a variance of 5^2 + 5^2; the right one was not read.
TEST(FieldSamplesTest, TwoSamplesOfAPixelTellItsNoise) {
    const StreamHeader header = two_pixels();
    FieldSamples field(header.shape);
    FieldCollector collector(header, field);
    collector.add({.slot = 0, .rows = 1, .dn = {100}});
    collector.add({.slot = 2, .rows = 1, .dn = {110}});
    const auto& [time, sums] = *field.exposures().begin();
    EXPECT_DOUBLE_EQ(field_exposure(time, sums, header).noise_dn2[0], 50);
}

TEST(FieldSamplesTest, ADroppedPacketHasNoSamples) {
    const StreamHeader header = two_pixels();
    FieldSamples field(header.shape);
    FieldCollector(header, field)
        .add({.slot = 0, .rows = 1, .flags = SamplePacket::kDropped, .dn = {}});
    EXPECT_TRUE(field.exposures().empty());
    EXPECT_EQ(field.fewest(), 0U);
}

}  // namespace
}  // namespace stipple
