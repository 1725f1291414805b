#include "core/homography.h"

#include <gtest/gtest.h>

#include <limits>

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 20, .cols = 30, .planes = 1};
const Homography kTilted({0.98, 0.05, 3.5, -0.04, 1.02, -2.25, 1e-4, -2e-4, 1});

TEST(HomographyTest, ShiftsByItsOffset) {
    const FramePoint moved = Homography::shift({.row = 2, .col = -3.5})({.row = 5, .col = 7});
    EXPECT_EQ(moved, (FramePoint{.row = 7, .col = 3.5}));
    EXPECT_TRUE(Homography::shift({}).is_identity());
}

TEST(HomographyTest, ActsOnColumnRowOne) {
    // (u, v, w) = (0.98 * 4 + 0.05 * 6 + 3.5, -0.04 * 4 + 1.02 * 6 - 2.25, 1 + 4e-4 - 12e-4)
    const FramePoint moved = kTilted({.row = 6, .col = 4});
    EXPECT_NEAR(moved.col, 7.72 / 0.9992, 1e-12);
    EXPECT_NEAR(moved.row, 3.71 / 0.9992, 1e-12);
}

TEST(HomographyTest, InverseLeadsBack) {
    for (const FramePoint place : {FramePoint{}, {19, 29}, {7.5, 2.25}}) {
        const FramePoint back = kTilted.inverse()(kTilted(place));
        EXPECT_NEAR(back.row, place.row, 1e-11);
        EXPECT_NEAR(back.col, place.col, 1e-11);
    }
    const FramePoint whole = Homography::shift({-3, 8}).inverse()({1, 1});
    EXPECT_EQ(whole, (FramePoint{.row = 4, .col = -7}));  // exact for offsets
}

TEST(HomographyTest, NoticesSingularMaps) {
    EXPECT_FALSE(kTilted.is_singular());
    EXPECT_FALSE(Homography::shift({6e4, -6e4}).is_singular());
    EXPECT_TRUE(Homography({0, 0, 0, 0, 0, 0, 0, 0, 0}).is_singular());
    EXPECT_TRUE(Homography({1, 2, 3, 2, 4, 6, 0, 0, 1}).is_singular());
    EXPECT_TRUE(Homography({1, 0, 0, 0, 1, 0, 0, 0, std::numeric_limits<double>::quiet_NaN()})
                    .is_singular());
}

TEST(HomographyTest, NoticesHorizonsInTheFrame) {
    EXPECT_TRUE(kTilted.is_finite_on(kShape));
    EXPECT_FALSE(Homography({1, 0, 0, 0, 1, 0, -0.1, 0, 1}).is_finite_on(kShape));
    EXPECT_TRUE(Homography({1, 0, 0, 0, 1, 0, -0.03, 0, 1}).is_finite_on(kShape));
}

TEST(HomographyTest, RoundsToTheNearestPixel) {
    EXPECT_EQ(nearest_pixel(kShape, {1.4, 2.6}), 33);
    EXPECT_EQ(nearest_pixel(kShape, {-0.4, -0.5}), 0);
    EXPECT_EQ(nearest_pixel(kShape, {-0.6, 3}), -1);
    EXPECT_EQ(nearest_pixel(kShape, {19.6, 3}), -1);
    EXPECT_EQ(nearest_pixel(kShape, {3, std::numeric_limits<double>::infinity()}), -1);
}

TEST(HomographyTest, CountsTheOverlap) {
    EXPECT_EQ(overlap_pixels({}, kShape), 600U);
    EXPECT_EQ(overlap_pixels(Homography::shift({5, -10}), kShape), 15U * 20U);
    EXPECT_EQ(overlap_pixels(Homography::shift({0, 30}), kShape), 0U);
}

}  // namespace
}  // namespace stipple
