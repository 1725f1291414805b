#include "decoder/naive/nearest_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "decoder/measurements.h"
#include "readout/schedules/schedule_catalogue.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

/// One site over time, from (first slot, open slots, sum, saturated) of its exposures.
struct Sample {
    int first_slot;
    int slots;
    float sum;
    bool saturated = false;
};

std::vector<float> estimate(int slots, const std::vector<Sample>& samples) {
    const auto count = static_cast<std::size_t>(slots);
    Measurements m{slots,
                   {1, 1, 1},
                   std::vector<std::uint8_t>(count),
                   std::vector<float>(count),
                   std::vector<float>(count),
                   false};
    for (const Sample& s : samples) {
        const auto first = static_cast<std::size_t>(s.first_slot);
        const std::size_t last = first + static_cast<std::size_t>(s.slots) - 1;
        for (std::size_t i = first; i <= last; ++i) m.state[i] = Measurements::kOpen;
        m.state[first] |= Measurements::kFirst;
        m.state[last] |= Measurements::kLast;
        if (s.saturated) m.state[last] |= Measurements::kSaturated;
        m.sum[last] = s.sum;
    }
    const FluxVideo x = nearest_samples(m);
    return {x.data().begin(), x.data().end()};
}

TEST(NearestSamplesTest, HoldTheFramesOfAConventionalCamera) {
    EXPECT_EQ(estimate(6, {{0, 2, 2}, {2, 2, 6}, {4, 2, 1}}),
              (std::vector<float>{1, 1, 3, 3, 0.5F, 0.5F}));
}

TEST(NearestSamplesTest, WeighByDistanceAndLengthWhereNothingIsKnown) {
    // Slot 2 is one slot from the first and two from the second; both last one slot.
    const auto x = estimate(5, {{1, 1, 1}, {4, 1, 3}});
    const double a = std::exp(-1 / 1.5) / 1.3, b = std::exp(-2 / 1.5) / 1.3;
    EXPECT_NEAR(x[2], (a * 1 + b * 3) / (a + b), 1e-6);
}

TEST(NearestSamplesTest, LetShorterExposuresSharpenLongerOnes) {
    const auto x = estimate(4, {{0, 1, 5}, {1, 3, 3}});
    const double own = 1 / 3.3, other = std::exp(-1 / 1.5) / 1.3;
    EXPECT_NEAR(x[1], (own * 1 + other * 5) / (own + other), 1e-6);
    EXPECT_EQ(x[0], 5);  // the short one does not listen to the long one
}

TEST(NearestSamplesTest, TakeSaturatedSamplesAsBounds) {
    EXPECT_EQ(estimate(5, {{0, 4, 2, true}, {4, 1, 3}})[1], 3);  // not a mean with 0.5
    EXPECT_EQ(estimate(5, {{0, 4, 4, true}, {4, 1, 0.5F}})[1], 1);
    EXPECT_EQ(estimate(7, {{0, 4, 2, true}, {4, 1, 2, true}, {5, 2, 2, true}})[1], 2);
    EXPECT_EQ(estimate(20, {{0, 4, 2, true}, {19, 1, 0.3F}})[1], 0.5F);
}

TEST(NearestSamplesTest, AreZeroForAPixelWithoutSamples) {
    EXPECT_EQ(estimate(3, {}), (std::vector<float>{0, 0, 0}));
}

// One store is open in even slots, the other in odd ones; each tells of its own slots alone.
TEST(NearestSamplesTest, HoldEachOfTwoBucketsInItsOwnSlots) {
    FluxVideo video(8, {.rows = 1, .cols = 1, .planes = 1});
    for (int slot = 0; slot < 8; ++slot)
        video.plane(slot, 0)(0, 0) = slot % 2 == 0 ? 0.125F : 0.375F;
    const ExposureSchedule two_buckets(1, 1, 8, {0, 2}, {{0, 0b1010101}, {1, 0b1010101}});
    const FluxVideo x = nearest_samples(measure(video, two_buckets, {.shot_noise = false}));
    for (int slot = 0; slot < 8; ++slot)  // one DN is 0.008, read noise 0.01 in a sum of 4 slots
        EXPECT_NEAR(x.plane(slot, 0)(0, 0), slot % 2 == 0 ? 0.125 : 0.375, 0.02) << slot;
}

TEST(NearestSamplesTest, RecoverALastingSceneButForNoise) {
    FluxVideo video(32, {.rows = 20, .cols = 30, .planes = 3});
    std::ranges::fill(video.data(), 0.5F);
    const FluxVideo x =
        nearest_samples(measure(video, random_schedule(20, 30, kPaperExposureSlots, 1)));
    double sum = 0;
    for (const float light : x.data()) sum += static_cast<double>(light);
    // Exposures of 4 and 8 slots saturate now and then and say nothing, those just below leave a
    // mean that is up to 1 percent too low.
    EXPECT_NEAR(sum / static_cast<double>(x.voxels()), 0.5, 0.005);
}

}  // namespace
}  // namespace stipple
