#include "decoder/conventional/block_filter.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/decoder/conventional/noisy_frames.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 40, .cols = 80, .planes = 1};
constexpr int kSide = 8;

// 2 pixels from frame to frame; the flow is exact to a fraction of a pixel in each.
TEST(BlockPathsTest, FollowATextureThatMoves) {
    const BlockPaths paths(moving_texture(9, kShape, 2), kSide);
    std::vector<BlockPlace> path;
    paths.follow({4, 16, 36}, 3, 100, path);
    ASSERT_EQ(path.size(), 7U);
    for (const BlockPlace& place : path) {
        EXPECT_EQ(place.frame, 1 + (&place - path.data()));
        EXPECT_NEAR(place.row, 16, 1);
        EXPECT_NEAR(place.col, 36 + 2 * (place.frame - 4), 1);
    }
    EXPECT_EQ(path[3].row, 16);
    EXPECT_EQ(path[3].col, 36);
}

TEST(BlockPathsTest, EndWithTheVideoAndStayInTheFrame) {
    const BlockPaths paths(moving_texture(5, kShape, 6), kSide);
    std::vector<BlockPlace> path;
    paths.follow({1, 0, 0}, 8, 0, path);
    ASSERT_EQ(path.size(), 5U);
    EXPECT_EQ(path.front().frame, 0);
    for (const BlockPlace& place : path) EXPECT_GE(place.col, 0);
    paths.follow_unchecked({2, 32, 72}, 1, 4, path);
    ASSERT_EQ(path.size(), 4U);
    for (const BlockPlace& place : path) EXPECT_LE(place.col, kShape.cols - kSide);
}

// Where a texture leaves the frame its motion has no partner.
TEST(BlockPathsTest, EndWhereTheMotionIsNotSure) {
    const BlockPaths paths(moving_texture(9, kShape, 6), kSide);
    std::vector<BlockPlace> path;
    paths.follow({4, 16, 66}, 4, 100, path);
    EXPECT_LT(path.back().frame, 7);
    EXPECT_EQ(path.front().frame, 0);
}

TEST(BlockPathsTest, SmallFramesStandStill) {
    const BlockPaths paths(moving_texture(3, {10, 12, 1}, 2), kSide);
    std::vector<BlockPlace> path;
    paths.follow({1, 1, 2}, 1, 255, path);
    ASSERT_EQ(path.size(), 3U);
    EXPECT_EQ(path.back().col, 2);
}

}  // namespace
}  // namespace stipple
