#include "decoder/naive/nearest_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/colour_filter.h"
#include "core/parallel.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

/// 1 at the sites whose colour their pixel sees.
std::vector<std::uint8_t> bayer_sites(ColourFilter cfa, FrameShape shape) {
    std::vector<std::uint8_t> sampled;
    for (int plane = 0; plane < 3; ++plane)
        for (int row = 0; row < shape.rows; ++row)
            for (int col = 0; col < shape.cols; ++col)
                sampled.push_back(colour_plane(cfa, row, col) == plane ? 1 : 0);
    return sampled;
}

FluxVideo masked(FluxVideo video, const std::vector<std::uint8_t>& sampled) {
    for (std::size_t i = 0; i < video.voxels(); ++i)
        if (sampled[i % sampled.size()] == 0) video.data()[i] = 99;
    return video;
}

TEST(UnsampledSitesTest, KeepWhatIsSampled) {
    const FluxVideo video = random_video(3, {7, 9, 3}, 1);
    FluxVideo x = video;
    fill_unsampled(std::vector<std::uint8_t>(7 * 9 * 3, 1), x);
    EXPECT_TRUE(std::ranges::equal(x.data(), video.data()));
    const auto sampled = bayer_sites(ColourFilter::kGrbg, {7, 9, 3});
    x = masked(video, sampled);
    fill_unsampled(sampled, x);
    for (std::size_t i = 0; i < x.voxels(); ++i)
        if (sampled[i % sampled.size()] != 0) {
            ASSERT_EQ(x.data()[i], video.data()[i]);
        }
}

// Bilinear interpolation is exact where light grows linearly, but at the rim.
TEST(UnsampledSitesTest, ContinueRampsOfEachColourOfAMosaic) {
    const FrameShape shape{9, 12, 3};
    FluxVideo video(2, shape);
    for (int slot = 0; slot < 2; ++slot)
        for (int plane = 0; plane < 3; ++plane)
            for (int row = 0; row < shape.rows; ++row)
                for (int col = 0; col < shape.cols; ++col)
                    video.plane(slot, plane)(row, col) =
                        static_cast<float>(1 + slot + plane * row + (3 - plane) * col) / 8;
    for (const auto cfa :
         {ColourFilter::kRggb, ColourFilter::kGrbg, ColourFilter::kGbrg, ColourFilter::kBggr}) {
        const auto sampled = bayer_sites(cfa, shape);
        FluxVideo x = masked(video, sampled);
        fill_unsampled(sampled, x);
        for (int slot = 0; slot < 2; ++slot)
            for (int plane = 0; plane < 3; ++plane)
                for (int row = 2; row < shape.rows - 2; ++row)
                    for (int col = 2; col < shape.cols - 2; ++col)
                        ASSERT_NEAR(x.plane(slot, plane)(row, col),
                                    video.plane(slot, plane)(row, col), 1e-5)
                            << name_of(cfa) << ' ' << plane << ' ' << row << ' ' << col;
    }
}

// Lines one pixel wide, which bilinear interpolation turns into colours.
TEST(UnsampledSitesTest, ContinueGreyLinesAlongThem) {
    const FrameShape shape{16, 18, 3};
    for (const bool vertical : {false, true}) {
        FluxVideo video(1, shape);
        for (int plane = 0; plane < 3; ++plane)
            for (int row = 0; row < shape.rows; ++row)
                for (int col = 0; col < shape.cols; ++col)
                    video.plane(0, plane)(row, col) =
                        (vertical ? col : row) % 7 == 4 ? 0.75F : 0.125F;
        const auto sampled = bayer_sites(ColourFilter::kGbrg, shape);
        FluxVideo x = masked(video, sampled);
        fill_unsampled(sampled, x);
        for (int plane = 0; plane < 3; ++plane)
            for (int row = 4; row < shape.rows - 4; ++row)
                for (int col = 4; col < shape.cols - 4; ++col)
                    ASSERT_NEAR(x.plane(0, plane)(row, col), video.plane(0, plane)(row, col), 1e-4)
                        << vertical << ' ' << plane << ' ' << row << ' ' << col;
    }
}

TEST(UnsampledSitesTest, FollowTheGuideWhereColoursKeepTheirDifference) {
    // Green is all there, red at one pixel, 0.5 above it; blue nowhere.
    const FrameShape shape{5, 4, 3};
    FluxVideo x = random_video(1, shape, 2);
    const FluxVideo before = x;
    std::vector<std::uint8_t> sampled(shape.sites());
    std::ranges::fill(sampled.begin() + 20, sampled.begin() + 40, std::uint8_t{1});
    sampled[7] = 1;
    x.data()[7] = x.data()[27] + 0.5F;
    fill_unsampled(sampled, x);
    for (std::size_t i = 0; i < 20; ++i) {
        EXPECT_EQ(x.data()[20 + i], before.data()[20 + i]);
        EXPECT_NEAR(x.data()[i], x.data()[20 + i] + 0.5F, 1e-6);
        EXPECT_EQ(x.data()[40 + i], x.data()[20 + i]);
    }
}

TEST(UnsampledSitesTest, GrowInwardsOverAHoleAndAreNotNegative) {
    FluxVideo x(1, {1, 7, 1});
    std::ranges::copy(std::vector<float>{4, 0, 0, 0, 0, 0, 1}, x.data().begin());
    fill_unsampled(std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0, 1}, x);
    EXPECT_EQ(std::vector<float>(x.data().begin(), x.data().end()),
              (std::vector<float>{4, 4, 4, 2.5F, 1, 1, 1}));
    // Red falls short of green by 2 on the left; green is 1 on the right.
    FluxVideo y(1, {1, 2, 3});
    std::ranges::copy(std::vector<float>{1, 0, 3, 1, 0, 0}, y.data().begin());
    fill_unsampled(std::vector<std::uint8_t>{1, 0, 1, 1, 0, 0}, y);
    EXPECT_EQ(y.data()[1], 0);
}

TEST(UnsampledSitesTest, StayAsTheyAreWithoutAnySample) {
    FluxVideo x(2, {3, 4, 3});
    fill_unsampled(std::vector<std::uint8_t>(36), x);
    EXPECT_TRUE(std::ranges::all_of(x.data(), [](float v) { return v == 0; }));
}

}  // namespace
}  // namespace stipple
