#include "decoder/joint/joint_measurements.h"

#include <gtest/gtest.h>

#include "tests/decoder/hand_made.h"

namespace stipple {
namespace {

constexpr int kSlots = 8;

/// A sensor whose samples have the variance dark + per_light X.
Measurements sensor(const std::vector<HandSample>& samples, float dark, float per_light) {
    Measurements m = hand_made(kSlots, kSite, samples);
    m.lsb_light = 1e-3F;
    m.dark_variance.assign(m.voxels(), dark);
    m.variance_per_light.assign(m.voxels(), per_light);
    return m;
}

TEST(MergedExposuresTest, AreTheMeanByInverseVariance) {
    // At the pooled light (4 x 1.0 + 1 x 1.5) / 5 = 1.1 the variances are 0.32 and 1.3.
    Measurements m = sensor({{.first_slot = 2, .open_slots = 0b11, .light = 1.0F}}, 0.045F, 0.25F);
    m.others.push_back(sensor({{.first_slot = 2, .open_slots = 0b11, .light = 1.5F}}, 0.2F, 1.0F));
    merge_equal_exposures(m);
    EXPECT_TRUE(m.others.empty());
    const double a = 1.3 / 1.62, b = 0.32 / 1.62;
    EXPECT_NEAR(m.sum[3], a * 1.0 + b * 1.5, 1e-6);
    EXPECT_NEAR(m.dark_variance[3], a * a * 0.045 + b * b * 0.2, 1e-7);
    EXPECT_NEAR(m.variance_per_light[3], a * a * 0.25 + b * b * 1.0, 1e-6);
    EXPECT_FLOAT_EQ(m.variance[3], m.variance_at(3, m.sum[3]));
}

TEST(MergedExposuresTest, SaturatedSamplesGiveWay) {
    const HandSample known{.first_slot = 1, .open_slots = 0b111, .light = 5};
    const HandSample bound{.first_slot = 1, .open_slots = 0b111, .light = 2, .saturated = true};
    const HandSample higher{.first_slot = 1, .open_slots = 0b111, .light = 3, .saturated = true};
    for (const auto& [first, second, saturated, light] :
         {std::tuple(bound, known, false, 5.0F), std::tuple(known, bound, false, 5.0F),
          std::tuple(bound, higher, true, 3.0F), std::tuple(higher, bound, true, 3.0F)}) {
        Measurements m = sensor({first}, 0.1F, 0.1F);
        m.others.push_back(sensor({second}, 0.1F, 0.1F));
        merge_equal_exposures(m);
        EXPECT_TRUE(m.others.empty());
        EXPECT_EQ(m.sum[3], light);
        EXPECT_EQ((m.state[3] & Measurements::kSaturated) != 0, saturated);
    }
}

TEST(MergedExposuresTest, OtherSlotsStayApart) {
    // The gap of the second one; its other exposure is equal.
    Measurements m = sensor({{.first_slot = 0, .open_slots = 0b111, .light = 1},
                             {.first_slot = 4, .open_slots = 0b101, .light = 1}},
                            0.1F, 0.1F);
    m.others.push_back(sensor({{.first_slot = 0, .open_slots = 0b101, .light = 1},
                               {.first_slot = 4, .open_slots = 0b101, .light = 1}},
                              0.1F, 0.1F));
    merge_equal_exposures(m);
    ASSERT_EQ(m.others.size(), 1U);
    EXPECT_NE(m.others[0].state[2], 0);
    EXPECT_EQ(m.others[0].state[4], 0);
    EXPECT_EQ(m.others[0].state[6], 0);
    EXPECT_FLOAT_EQ(m.dark_variance[2], 0.1F);
    EXPECT_FLOAT_EQ(m.dark_variance[6], 0.05F);
}

TEST(MergedExposuresTest, ThreeSensorsMergeLikeTwo) {
    Measurements m = sensor({{.first_slot = 3, .light = 1}}, 0.3F, 0.3F);
    for (int i = 0; i < 2; ++i)
        m.others.push_back(sensor({{.first_slot = 3, .light = 4}}, 0.3F, 0.3F));
    merge_equal_exposures(m);
    EXPECT_TRUE(m.others.empty());
    EXPECT_FLOAT_EQ(m.sum[3], 3);
    EXPECT_FLOAT_EQ(m.dark_variance[3], 0.1F);
}

}  // namespace
}  // namespace stipple
