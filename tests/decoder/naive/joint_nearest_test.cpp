#include "decoder/naive/nearest_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/decoder/hand_made.h"

namespace stipple {
namespace {

constexpr int kSlots = 6;

TEST(JointNearestTest, SensorsCountByTheirPhotons) {
    // Both are open in slots 1 and 2; the second has a third of the variance.
    Measurements m = hand_made(kSlots, kSite, {{.first_slot = 1, .open_slots = 0b11, .light = 2}});
    m.others.push_back(
        hand_made(kSlots, kSite, {{.first_slot = 1, .open_slots = 0b11, .light = 4}}));
    m.variance[2] = 0.3F;
    m.others[0].variance[2] = 0.1F;
    const FluxVideo x = nearest_samples(m);
    EXPECT_FLOAT_EQ(x.data()[1], (1 * 1 + 3 * 2) / 4.0F);
}

TEST(JointNearestTest, ShorterExposuresAroundSharpen) {
    Measurements m = hand_made(kSlots, kSite, {{.first_slot = 0, .open_slots = 0b111, .light = 3}});
    m.others.push_back(hand_made(kSlots, kSite, {{.first_slot = 3, .open_slots = 1, .light = 5}}));
    m.variance[2] = 3e-4F;  // that of shot noise: n var is the same for both
    const FluxVideo x = nearest_samples(m);
    const double own = 1 / 3.3, other = std::exp(-1 / 1.5) / 1.3;
    EXPECT_NEAR(x.data()[2], (own * 1 + other * 5) / (own + other), 1e-5);
    EXPECT_EQ(x.data()[3], 5);
}

TEST(JointNearestTest, BoundsHoldWhereAllAreSaturated) {
    const HandSample bound{.first_slot = 2, .open_slots = 1, .light = 8, .saturated = true};
    Measurements m =
        hand_made(kSlots, kSite, {{.first_slot = 0, .open_slots = 1, .light = 1}, bound});
    m.others.push_back(hand_made(kSlots, kSite, {{.first_slot = 2, .open_slots = 1, .light = 20}}));
    EXPECT_NEAR(nearest_samples(m).data()[2], 20, 1e-5);  // the other one knows better
    m.others[0] = hand_made(kSlots, kSite, {bound});
    EXPECT_EQ(nearest_samples(m).data()[2], 8);
}

}  // namespace
}  // namespace stipple
