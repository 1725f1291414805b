#include "decoder/conventional/vbm4d.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/decoder/conventional/noisy_frames.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 40, .cols = 48, .planes = 1};

double fall_of(const FluxVideo& truth, const Vbm4dOptions& options, int frame) {
    const DeliveredFrames frames = noisy_frames(truth, kPaperNoise);
    const auto x = filter_volumes(frames, options);
    return error_of(frames.light, truth, frame) / error_of(*x, truth, frame);
}

// At least as many samples as the 9 frames of a volume.
TEST(Vbm4dTest, TheVarianceOfAStaticSceneFallsByMoreThanTheNumberOfFrames) {
    EXPECT_GT(fall_of(moving_texture(9, kShape, 0), {}, 4), 20);
    EXPECT_GT(fall_of(moving_texture(9, {32, 40, 3}, 0), {}, 4), 20);
}

// A texture that repeats itself every 4 pixels, but has no few coefficients in a block.
TEST(Vbm4dTest, FramesOfAVolumeAndVolumesOfAGroupBothDenoise) {
    const auto tile = random_values(16, 0.4F, 0.6F, 1);
    FluxVideo truth(5, kShape);
    for (int frame = 0; frame < 5; ++frame)
        for (int row = 0; row < kShape.rows; ++row)
            for (int col = 0; col < kShape.cols; ++col)
                truth.plane(frame, 0)(row, col) =
                    tile[static_cast<std::size_t>(row % 4 * 4 + col % 4)];
    const double both = fall_of(truth, {}, 2);
    EXPECT_GT(both, 1.3 * fall_of(truth, {.reach_frames = 0}, 2)) << "volumes of one frame";
    EXPECT_GT(both, 1.05 * fall_of(truth, {.max_volumes = 1}, 2)) << "groups of one volume";
}

TEST(Vbm4dTest, AMovingEdgeStaysSharp) {
    const FluxVideo truth = moving_edge(5, kShape, 3);
    const DeliveredFrames frames = noisy_frames(truth, kPaperNoise);
    const auto x = filter_volumes(frames, {});
    EXPECT_LT(error_of(*x, truth, 2), 0.2 * error_of(frames.light, truth, 2));
    EXPECT_LT(x->plane(2, 0)(20, 24), 0.25F);
    EXPECT_GT(x->plane(2, 0)(20, 27), 0.55F);
}

TEST(Vbm4dTest, WithLittleNoiseFramesAreReturned) {
    const DeliveredFrames frames{random_video(3, kShape, 1),
                                 {.dark_variance = 0, .per_light = 1e-9F}};
    const auto x = filter_volumes(frames, {});
    EXPECT_LT(std::sqrt(mean_square(x->data(), frames.light.data())), 3e-5);  // its noise
}

}  // namespace
}  // namespace stipple
