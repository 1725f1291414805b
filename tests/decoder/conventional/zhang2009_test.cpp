#include "decoder/conventional/zhang2009.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/decoder/conventional/noisy_frames.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 48, .cols = 64, .planes = 1};

double fall_of(const FluxVideo& truth, const Zhang2009Options& options, int frame) {
    const DeliveredFrames frames = noisy_frames(truth, kPaperNoise);
    const auto x = denoise_along_flow(frames, options);
    return error_of(frames.light, truth, frame) / error_of(*x, truth, frame);
}

// The middle one of 11 frames has a whole stack; overlapping stacks bring a little more.
TEST(Zhang2009Test, TheVarianceOfAStaticSceneFallsByAboutTheNumberOfFrames) {
    EXPECT_GT(fall_of(moving_texture(11, kShape, 0), {}, 5), 8);
    EXPECT_GT(fall_of(moving_texture(11, {48, 64, 3}, 0), {}, 5), 8);
    EXPECT_NEAR(fall_of(moving_texture(3, kShape, 0), {.reach_frames = 1}, 1), 3, 0.8);
}

// Along the flow a texture that moves is as if it stood still, but for the rounding of positions.
TEST(Zhang2009Test, AMovingTextureIsDenoisedAlongItsFlow) {
    EXPECT_GT(fall_of(moving_texture(11, kShape, 2), {}, 5), 5);
}

TEST(Zhang2009Test, AMovingEdgeStaysSharp) {
    const FluxVideo truth = moving_edge(9, kShape, 3);
    const DeliveredFrames frames = noisy_frames(truth, kPaperNoise);
    const auto x = denoise_along_flow(frames, {});
    EXPECT_LT(error_of(*x, truth, 4), 0.5 * error_of(frames.light, truth, 4));
    EXPECT_LT(x->plane(4, 0)(24, 30), 0.25F);
    EXPECT_GT(x->plane(4, 0)(24, 33), 0.55F);
}

TEST(Zhang2009Test, WithLittleNoiseFramesAreReturned) {
    const DeliveredFrames frames{random_video(5, kShape, 1),
                                 {.dark_variance = 0, .per_light = 1e-9F}};
    const auto x = denoise_along_flow(frames, {});
    EXPECT_LT(std::sqrt(mean_square(x->data(), frames.light.data())), 3e-5);  // its noise
}

}  // namespace
}  // namespace stipple
