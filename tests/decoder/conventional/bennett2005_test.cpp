#include "decoder/conventional/bennett2005.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "decoder/conventional/fast_gaussian.h"
#include "tests/decoder/conventional/noisy_frames.h"
#include "tests/decoder/recordings.h"
#include "tests/support/expect_quality.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 48, .cols = 64, .planes = 1};

// exp(-x) to (x^2 / 32) exp(-x), the next term of the logarithm.
TEST(BellTest, IsNearAnExponential) {
    EXPECT_EQ(fast_gaussian(0), 1);
    EXPECT_NEAR(fast_gaussian(0.5F), 0.6065, 0.006);
    EXPECT_NEAR(fast_gaussian(2), 0.1353, 0.02);
    EXPECT_EQ(fast_gaussian(16), 0);
    EXPECT_EQ(fast_gaussian(1e9F), 0);
}

// Of 9 frames with nearly equal weights; those of noise scatter.
TEST(Bennett2005Test, TheVarianceOfAStaticSceneFallsByAboutTheNumberOfFrames) {
    for (const FrameShape shape : {kShape, FrameShape{48, 64, 3}}) {
        const FluxVideo truth = moving_texture(9, shape, 0);
        const DeliveredFrames frames = noisy_frames(truth, kPaperNoise);
        Bennett2005Options options;
        options.radius_px = 0;
        const auto x = accumulate_samples(frames, options);
        const double fall = error_of(frames.light, truth, 4) / error_of(*x, truth, 4);
        EXPECT_GT(fall, 6.5);
        EXPECT_LT(fall, 9.5);
    }
}

// Without other frames a flat area accumulates the pixels around until weights add up to 10. Spread
// over the n = 4 pi 1.5^2 = 28 pixels of a Gaussian, the variance is (1 + 9^2 / n) / 10^2 = 1 / 26;
// the range sigma makes n less.
TEST(Bennett2005Test, WhatFindsNoFramesAccumulatesNeighbours) {
    FluxVideo truth(1, kShape);
    std::ranges::fill(truth.data(), 0.05F);
    const DeliveredFrames frames = noisy_frames(truth, kPaperNoise);
    const auto x = accumulate_samples(frames, {.max_samples = 10});
    const double fall = error_of(frames.light, truth, 0) / error_of(*x, truth, 0);
    EXPECT_GT(fall, 8);
    EXPECT_LT(fall, 26);
    const auto brief = accumulate_samples(frames, {.max_samples = 1});
    EXPECT_TRUE(std::ranges::equal(brief->data(), frames.light.data())) << "one is enough";
}

// What would be averaged over 9 frames without regard to motion is off by up to 0.4.
TEST(Bennett2005Test, AMovingEdgeStaysSharp) {
    const FluxVideo truth = moving_edge(9, kShape, 3);
    const DeliveredFrames frames = noisy_frames(truth, kPaperNoise);
    const auto x = accumulate_samples(frames, {});
    EXPECT_LT(error_of(*x, truth, 4), 0.5 * error_of(frames.light, truth, 4));
    EXPECT_LT(x->plane(4, 0)(24, 30), 0.25F);
    EXPECT_GT(x->plane(4, 0)(24, 33), 0.55F);
}

TEST(Bennett2005Test, WithLittleNoiseFramesAreReturned) {
    const DeliveredFrames frames{moving_edge(5, kShape, 3),
                                 {.dark_variance = 0, .per_light = 1e-9F}};
    const auto x = accumulate_samples(frames, {});
    EXPECT_LT(std::sqrt(mean_square(x->data(), frames.light.data())), 3e-5);  // its noise
}

}  // namespace
}  // namespace stipple
