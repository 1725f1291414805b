#include "decoder/best/patch_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/parallel.h"
#include "tests/decoder/recordings.h"
#include "tests/support/expect_quality.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 150, .cols = 30, .planes = 1};  // three bands of rows

FluxVideo stripes(int slots, FrameShape shape) {
    FluxVideo video(slots, shape);
    for (std::size_t i = 0; i < video.voxels(); ++i) video.data()[i] = i % 10 < 5 ? 0.5F : 1.5F;
    return video;
}

FluxVideo noisy(const FluxVideo& video, float sigma) {
    FluxVideo result = video;
    std::mt19937 random(7);
    std::normal_distribution<float> noise(0, sigma);
    for (float& x : result.data()) x += noise(random);
    return result;
}

TEST(CollaborativeFilterTest, WithoutNoiseNothingChanges) {
    const FluxVideo video = random_video(4, {40, 31, 3}, 1);
    const PatchGroups groups = match_patches(video, {video.shape(), 5, 2}, {}, {});
    FluxVideo filtered(4, video.shape());
    filter_groups(video, video, groups, 0, {filtered});
    for (std::size_t i = 0; i < video.voxels(); ++i)
        EXPECT_NEAR(filtered.data()[i], video.data()[i], 1e-5F);
}

TEST(CollaborativeFilterTest, WithAPerfectPilotLittleNoiseIsLeft) {
    constexpr float kSigma = 0.1F;
    const FluxVideo video = stripes(6, kShape);
    const FluxVideo seen = noisy(video, kSigma);
    const PatchGroups groups = match_patches(video, {kShape, 5, 0}, {}, {});
    FluxVideo filtered(6, kShape);
    filter_groups(seen, video, groups, kSigma, {filtered});
    // Stripes have some ten coefficients of 576 that are not 0, and every voxel is in many groups.
    expect_quality(
        "filtered",
        gain_db(mean_square(filtered.data(), video.data()), mean_square(seen.data(), video.data())),
        16.73);
}

TEST(CollaborativeFilterTest, CountsTheCoefficientsThatItKeeps) {
    constexpr float kAll = 6 * 6 * 16;  // of a group
    for (const int planes : {1, 2, 3}) {
        const FrameShape shape{40, 31, planes};
        const auto expect_gain = [&](const FluxVideo& video, float sigma, float kept) {
            const PatchGroups groups = match_patches(video, {shape, 5, 2}, {}, {});
            FluxVideo filtered(4, shape), gain;
            filter_groups(video, video, groups, sigma, {filtered, &gain});
            for (const float value : gain.data()) ASSERT_NEAR(value, kept, 1e-3F * kept) << planes;
        };
        expect_gain(random_video(4, shape, 1), 1e-6F, kAll);
        expect_gain(flat_video(4, shape, 0.7F), 1e-3F, 1);  // the mean
    }
}

TEST(CollaborativeFilterTest, TheSameBitsForAnyNumberOfThreads) {
    const FluxVideo video = random_video(30, kShape, 3);  // several bands of slots too
    const PatchGroups groups =
        match_patches(video, {kShape, 5, 3}, {}, {.slots = 2, .own_radius = 3, .path_radius = 2});
    const auto filter = [&](int threads) {
        const ThreadLimit limit(threads);
        FluxVideo filtered(video.slots(), kShape);
        filter_groups(video, video, groups, 0.3F, {filtered});
        return std::vector<float>(filtered.data().begin(), filtered.data().end());
    };
    const auto one = filter(1);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(filter(2), one);
}

}  // namespace
}  // namespace stipple
