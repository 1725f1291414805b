#include "decoder/hitomi2011/ksvd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr AtomShape kPatch{.slots = 3, .side_px = 2};

std::vector<float> drawn(const FluxVideo& video, std::size_t count, std::uint64_t seed) {
    TrainingPatches patches(kPatch, count, seed);
    patches.begin_clip(video.shape());
    for (int slot = 0; slot < video.slots(); ++slot) patches.add_frame(video.frame(slot));
    return patches.take();
}

TEST(TrainingPatchesTest, HaveAMeanOf1) {
    const auto patches = drawn(random_video(6, {9, 12, 3}, 1), 500, 1);
    ASSERT_EQ(patches.size(), 500 * kPatch.voxels());
    for (std::size_t i = 0; i < 500; ++i) {
        const auto patch = std::span(patches).subspan(i * 12, 12);
        EXPECT_NEAR(std::accumulate(patch.begin(), patch.end(), 0.0) / 12, 1, 1e-6);
    }
}

// A frame that is one patch, of slots 1, 2, 3 with rows and columns told apart: all 16 symmetries
// of space and time occur, and nothing else.
TEST(TrainingPatchesTest, AreTurnedMirroredAndReversed) {
    FluxVideo video(3, {2, 2, 1});
    for (std::size_t i = 0; i < 12; ++i)
        video.data()[i] = static_cast<float>(i < 4 ? 1 + i : 6 + i / 4);
    const auto patches = drawn(video, 256, 1);
    std::vector<std::vector<float>> different;
    for (std::size_t i = 0; i < 256; ++i) {
        std::vector<float> patch(patches.begin() + static_cast<std::ptrdiff_t>(12 * i),
                                 patches.begin() + static_cast<std::ptrdiff_t>(12 * i + 12));
        if (std::ranges::find(different, patch) == different.end()) different.push_back(patch);
        const bool reversed = patch[0] == patch[1];
        auto slot = std::span(patch).subspan(reversed ? 8 : 0, 4);
        std::ranges::sort(slot);
        EXPECT_NEAR(slot[3] / slot[0], 4, 1e-5);
    }
    EXPECT_EQ(different.size(), 16U);
}

// Of 20 frames those of a window early and late are as likely.
TEST(TrainingPatchesTest, AllFramesAreAsLikely) {
    FluxVideo video(20, {8, 8, 1});
    for (int slot = 0; slot < 20; ++slot)
        for (std::size_t i = 0; i < 64; ++i)
            video.frame(slot)[i] = i % 2 == 0 ? 1 : static_cast<float>(2 + slot);
    const auto patches = drawn(video, 1000, 5);
    int late = 0;
    for (std::size_t i = 0; i < 1000; ++i) {
        const auto patch = std::span(patches).subspan(i * 12, 12);
        const auto [least, most] = std::ranges::minmax(patch);
        late += most / least > 12.5F ? 1 : 0;  // the brightest slot is one of 11 to 19
    }
    // 9 of 18 windows: binomial, standard deviation sqrt(1000) / 2 = 16.
    EXPECT_NEAR(late, 500, 80);
}

TEST(TrainingPatchesTest, FlatAndDarkPatchesAreLeftOutAndSeedsDiffer) {
    FluxVideo flat(5, {8, 8, 1});
    EXPECT_TRUE(drawn(flat, 10, 1).empty());
    std::ranges::fill(flat.data(), 0.5F);
    EXPECT_TRUE(drawn(flat, 10, 1).empty());
    const FluxVideo video = random_video(5, {8, 8, 1}, 1);
    EXPECT_EQ(drawn(video, 50, 1), drawn(video, 50, 1));
    EXPECT_NE(drawn(video, 50, 1), drawn(video, 50, 2));
    EXPECT_TRUE(drawn(random_video(2, {8, 8, 1}, 1), 50, 1).empty()) << "shorter than a patch";
}

}  // namespace
}  // namespace stipple
