#include "decoder/reddy2011/sparse_frames.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/index.h"

#include "tests/decoder/hand_made.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

// One pixel without levels has no wavelet term: the nearest light to the start that explains the
// samples.
TEST(SparseFramesTest, WithoutLevelsSamplesAreExplainedExactly) {
    Measurements m =
        hand_made(4, kSite, {{.open_slots = 0b101, .light = 3}, {.first_slot = 3, .light = 0.5F}});
    FluxVideo x(4, kSite);
    SparseFramesSolver(m, 3).minimise({.iterations = 3, .wavelet_weight = 1}, x);
    const std::vector<float> expected{1.5F, 0, 1.5F, 0.5F};
    for (int slot = 0; slot < 4; ++slot)
        EXPECT_NEAR(x.frame(slot)[0], expected[static_cast<std::size_t>(slot)], 1e-5F);

    m.weight = {2, 1, 1, 1};  // y = 2 x0 + x2: the nearest to 0 is (2, 1) * 3 / 5
    std::ranges::fill(x.data(), 0.0F);
    SparseFramesSolver(m, 3).minimise({.iterations = 3}, x);
    EXPECT_NEAR(x.frame(0)[0], 1.2F, 1e-5F);
    EXPECT_NEAR(x.frame(2)[0], 0.6F, 1e-5F);
}

TEST(SparseFramesTest, ASaturatedSampleIsALowerBound) {
    const Measurements m =
        hand_made(2, kSite, {{.open_slots = 0b11, .light = 2, .saturated = true}});
    for (const auto& [start, end] : {std::pair{0.5F, 1.0F}, {3.0F, 3.0F}}) {
        FluxVideo x(2, kSite);
        std::ranges::fill(x.data(), start);
        SparseFramesSolver(m, 3).minimise({.iterations = 5}, x);
        EXPECT_NEAR(x.frame(0)[0], end, 1e-5F);
    }
}

// All pixels observed in single slots: the minimum is the soft threshold of the coefficients.
TEST(SparseFramesTest, FullFramesAreShrunkInTheWaveletDomain) {
    constexpr FrameShape kShape{.rows = 16, .cols = 16, .planes = 1};
    const FluxVideo light = random_video(1, kShape, 1);
    std::vector<HandSample> samples;
    for (std::size_t site = 0; site < kShape.sites(); ++site)
        samples.push_back({.site = site, .light = light.frame(0)[site]});
    FluxVideo x(1, kShape);
    const Measurements m = hand_made(1, kShape, samples);
    SparseFramesSolver(m, 2).minimise({.iterations = 40, .wavelet_weight = 0.1F}, x);
    FluxVideo expected = light;
    const WaveletTransform wavelet(kShape, 2);
    wavelet.forward(expected.plane(0, 0));
    wavelet.shrink(expected.plane(0, 0), 0.1F);
    wavelet.inverse(expected.plane(0, 0));
    EXPECT_LT(mean_square(x.data(), expected.data()), 1e-10);
    EXPECT_GT(mean_square(light.data(), expected.data()), 1e-3);
}

// A scene without motion, known to be so: each slot learns from the noisy samples of all, 24 of
// them more than 8.
TEST(SparseFramesTest, AStaticSceneIsBetterFromAllSlotsThanFromOneFrame) {
    constexpr FrameShape kShape{.rows = 16, .cols = 16, .planes = 1};
    const FluxVideo noise = random_video(24, kShape, 1);
    const auto error = [&](int slots, bool linked) {
        std::vector<HandSample> samples;  // of light 0.5, one for 8 slots
        for (std::size_t site = 0; site < kShape.sites(); ++site)
            for (int slot = 0; slot < slots; slot += 8)
                samples.push_back({.site = site,
                                   .first_slot = slot,
                                   .open_slots = 0b10011001,
                                   .light = 4 * 0.5F + noise.frame(slot)[site] - 0.5F});
        std::vector<MotionField> still(2);
        still[1].step = -1;
        for (MotionField& field : still) {
            field.row_shift.assign(index(slots) * kShape.pixels(), 0);
            field.col_shift = field.row_shift;
            field.confidence.assign(index(slots) * kShape.pixels(), 255);
            const std::size_t without = field.step > 0 ? index(slots - 1) : 0;  // a partner
            for (std::size_t i = 0; i < kShape.pixels(); ++i)
                field.confidence[without * kShape.pixels() + i] = 0;
        }
        const FlowLinks links(still, kShape, 0.5F);
        const Measurements m = hand_made(slots, kShape, samples);
        FluxVideo x(slots, kShape), truth(slots, kShape);
        std::ranges::fill(truth.data(), 0.5F);
        SparseFramesSolver(m, 0).minimise(
            {.iterations = 300, .flow_weight = 10, .links = linked ? &links : nullptr}, x);
        return mean_square(x.data(), truth.data());
    };
    // The mean of three samples has a third of the variance; closed slots stay at 0 without links.
    EXPECT_NEAR(error(24, true) / error(8, true), 1.0 / 3, 0.1);
    EXPECT_GT(error(8, false), 10 * error(8, true));
}

}  // namespace
}  // namespace stipple
