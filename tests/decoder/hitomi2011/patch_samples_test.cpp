#include "decoder/hitomi2011/patch_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/decoder/hand_made.h"
#include "tests/decoder/hitomi2011/cosine_dictionary.h"

namespace stipple {
namespace {

/// A patch of one pixel and four slots: a constant and a slope.
PatchDictionary lines() {
    const std::vector<double> values{1, 1, 1, 1, -3, -1, 1, 3};
    return patch_dictionary({2, 4, 1}, values, "lines");
}

/// The light of a code in each slot.
std::vector<float> light_of(const SparseCode& code, const PatchDictionary& d) {
    std::vector<float> light(d.shape.voxels());
    for (std::size_t k = 0; k < code.atoms.size(); ++k)
        for (std::size_t i = 0; i < light.size(); ++i)
            light[i] += code.weights[k] * d.atom(code.atoms[k])[i];
    return light;
}

TEST(PatchSamplesTest, SamplesDecideTheSumOfAtoms) {
    const PatchDictionary d = lines();
    // Light 1, 2, 3, 4: slots 0 and 2 together, and slot 3.
    Measurements m =
        hand_made(4, kSite, {{.open_slots = 0b101, .light = 1 + 3}, {.first_slot = 3, .light = 4}});
    const auto expect_ramp = [&] {
        const auto light = light_of(PatchSamples(m, d).code({}, {.max_atoms = 2}), d);
        for (int slot = 0; slot < 4; ++slot) EXPECT_NEAR(light[index(slot)], 1 + slot, 1e-4F);
    };
    expect_ramp();
    m.weight = {2, 1, 0.5F, 1};
    m.sum[2] = 2 * 1 + 0.5F * 3;
    expect_ramp();
}

TEST(PatchSamplesTest, ExposuresThatReachBeyondThePatchAreLeftOut) {
    const PatchDictionary d = lines();
    const Measurements m = hand_made(8, kSite,
                                     {{.first_slot = 2, .open_slots = 0b11, .light = 2},
                                      {.first_slot = 4, .open_slots = 0b1111, .light = 100}});
    const PatchSamples samples(m, d);
    EXPECT_EQ(samples.exposures_by_first_slot(),
              (std::vector<std::size_t>{1, 1, 1, 0, 1, 0, 0, 0}));
    const SparseCode code = samples.code({.slot = 2}, {.max_atoms = 2});
    ASSERT_EQ(code.atoms.size(), 1U) << "one sample, one atom";
    const auto light = light_of(code, d);
    EXPECT_NEAR(light[0] + light[1], 2, 1e-4F);
    EXPECT_TRUE(samples.code({.slot = 3}, {.max_atoms = 2}).atoms.empty());
}

TEST(PatchSamplesTest, ThePursuitEndsAtTheNoise) {
    const PatchDictionary d = lines();
    Measurements m =
        hand_made(4, kSite, {{.first_slot = 0, .light = 1.0F}, {.first_slot = 3, .light = 1.1F}});
    // The constant 1.05 leaves 2 * 0.05^2.
    m.variance.assign(4, 0.0026F);
    EXPECT_EQ(PatchSamples(m, d).code({}, {2, 1}).atoms.size(), 1U);
    m.variance.assign(4, 0.0024F);
    EXPECT_EQ(PatchSamples(m, d).code({}, {2, 1}).atoms.size(), 2U);
    EXPECT_EQ(PatchSamples(m, d).code({}, {2, 2}).atoms.size(), 1U);
}

TEST(PatchSamplesTest, SaturatedSamplesAreLowerBounds) {
    const PatchDictionary d = lines();
    const auto light = [&](float first, float bound) {
        const Measurements m = hand_made(
            4, kSite, {{.light = first}, {.first_slot = 1, .light = bound, .saturated = true}});
        return light_of(PatchSamples(m, d).code({}, {.max_atoms = 1}), d)[1];
    };
    EXPECT_NEAR(light(3, 2), 3, 1e-4F) << "the other sample says more";
    EXPECT_NEAR(light(1, 2), 1.5, 1e-4F) << "between both: one atom cannot meet both";
    // All are bounds, of 8 and of 2 slots: the higher one holds.
    const Measurements m =
        hand_made(4, kSite,
                  {{.light = 2, .saturated = true},
                   {.first_slot = 1, .open_slots = 0b111, .light = 2, .saturated = true}});
    EXPECT_NEAR(light_of(PatchSamples(m, d).code({}, {.max_atoms = 1}), d)[2], 2, 1e-3F);
}

}  // namespace
}  // namespace stipple
