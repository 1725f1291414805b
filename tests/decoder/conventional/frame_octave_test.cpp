#include "decoder/conventional/shahar2011.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/decoder/conventional/noisy_frames.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 24, .cols = 40, .planes = 1};

TEST(FrameOctaveTest, PairsHaveTheirFrameAsMean) {
    for (const FrameShape shape : {kShape, FrameShape{12, 14, 3}, FrameShape{3, 2, 1}})
        for (const int count : {1, 2, 6}) {
            const FluxVideo frames = random_video(count, shape, 1);
            const FluxVideo x = upsampled_frames(frames, Octave::kSplit, 1e-4F, {});
            ASSERT_EQ(x.slots(), 2 * count);
            for (int k = 0; k < count; ++k)
                for (std::size_t i = 0; i < shape.sites(); ++i)
                    ASSERT_NEAR((x.frame(2 * k)[i] + x.frame(2 * k + 1)[i]) / 2, frames.frame(k)[i],
                                1e-6);
        }
}

TEST(FrameOctaveTest, FramesAreInsertedBetweenThoseGiven) {
    const FluxVideo frames = random_video(5, kShape, 1);
    const FluxVideo x = upsampled_frames(frames, Octave::kInsert, 1e-4F, {});
    ASSERT_EQ(x.slots(), 9);
    for (int k = 0; k < 5; ++k) EXPECT_TRUE(std::ranges::equal(x.frame(2 * k), frames.frame(k)));
}

// A light that blinks: dark, dark, bright, bright, ... in frames of 2, and the same at half the
// rate beside it. Interpolation cannot know that frames of 1 are dark, bright; the slow light shows
// it.
TEST(FrameOctaveTest, ALightThatBlinksTooFastIsResolvedByOneThatBlinksSlowly) {
    const int count = 16;
    FluxVideo fine(2 * count, kShape);
    FluxVideo frames(count, kShape);
    const float levels[4] = {0.2F, 0.8F, 0.6F, 0.3F};
    for (int k = 0; k < 2 * count; ++k)
        for (int row = 0; row < kShape.rows; ++row)
            for (int col = 0; col < kShape.cols; ++col)
                fine.plane(k, 0)(row, col) = levels[(row < kShape.rows / 2 ? k / 2 : k) % 4] +
                                             0.1F * static_cast<float>((row * 5 + col * 3) % 4);
    for (int k = 0; k < count; ++k)
        for (std::size_t i = 0; i < kShape.sites(); ++i)
            frames.frame(k)[i] = (fine.frame(2 * k)[i] + fine.frame(2 * k + 1)[i]) / 2;
    const auto error = [&](const OctaveOptions& options) {
        const FluxVideo x = upsampled_frames(frames, Octave::kSplit, 1e-6F, options);
        double sum = 0;
        for (int k = 8; k < 24; ++k)
            for (int row = 14; row < 22; ++row)
                for (int col = 4; col < 36; ++col) {
                    const double d = static_cast<double>(x.plane(k, 0)(row, col)) -
                                     static_cast<double>(fine.plane(k, 0)(row, col));
                    sum += d * d;
                }
        return sum;
    };
    EXPECT_LT(error({.search_px = 12, .search_frames = 6}), 0.2 * error({.start_weight = 100}));
}

}  // namespace
}  // namespace stipple
