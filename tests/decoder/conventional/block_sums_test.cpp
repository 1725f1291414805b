#include "decoder/conventional/block_filter.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/index.h"
#include "core/parallel.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

const auto kGoOn = [](double) { return true; };

/// The reference block as it is in a video.
FilteredBlocks copied(const FluxVideo& video, const BlockPlace& reference, int side) {
    FilteredBlocks blocks{{reference}, {}, {}};
    for (int plane = 0; plane < video.shape().planes; ++plane) {
        for (int row = 0; row < side; ++row)
            for (int col = 0; col < side; ++col)
                blocks.values.push_back(
                    video.plane(reference.frame, plane)(reference.row + row, reference.col + col));
        blocks.weights.push_back(0.5F);
    }
    return blocks;
}

TEST(BlockSumsTest, CopiedBlocksGiveTheVideo) {
    for (const FrameShape shape : {FrameShape{17, 23, 3}, FrameShape{8, 8, 1}}) {
        const FluxVideo video = random_video(2, shape, 1);
        for (const int step : {1, 3, 8}) {
            const auto x = filter_blocks(
                {2, shape, 8, step},
                [&](const BlockPlace& reference) { return copied(video, reference, 8); }, kGoOn);
            for (std::size_t i = 0; i < video.voxels(); ++i)
                ASSERT_NEAR(x->data()[i], video.data()[i], 1e-6);
        }
    }
}

TEST(BlockSumsTest, AVoxelIsTheMeanByWeight) {
    const FrameShape shape{8, 8, 1};
    const auto x = filter_blocks(
        {2, shape, 8, 8},
        [&](const BlockPlace& reference) {
            FilteredBlocks blocks{{reference, {1 - reference.frame, 0, 0}}, {}, {}};
            blocks.values.assign(128, static_cast<float>(reference.frame));
            blocks.weights.push_back(reference.frame == 0 ? 3.0F : 1.0F);
            return blocks;
        },
        kGoOn);
    for (const float value : x->data()) ASSERT_FLOAT_EQ(value, 0.25F);
}

TEST(BlockSumsTest, GivesTheSameBitsForAnyNumberOfThreadsAndStops) {
    const FluxVideo video = random_video(3, {40, 40, 1}, 1);
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        return filter_blocks(
            {3, video.shape(), 8, 3},
            [&](const BlockPlace& reference) {
                FilteredBlocks blocks = copied(video, reference, 8);
                blocks.places.push_back({reference.frame, 16, 16});  // all of them
                blocks.values.insert(blocks.values.end(), 64,
                                     0.1F * static_cast<float>(reference.row));
                return blocks;
            },
            kGoOn);
    };
    EXPECT_TRUE(std::ranges::equal(with(1)->data(), with(2)->data()));
    EXPECT_FALSE(filter_blocks(
        {3, video.shape(), 8, 3},
        [&](const BlockPlace& reference) { return copied(video, reference, 8); },
        [](double) { return false; }));
}

}  // namespace
}  // namespace stipple
