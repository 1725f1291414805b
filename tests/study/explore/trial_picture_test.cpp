#include "study/explore/trial.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "io/tone_map.h"

namespace stipple {
namespace {

std::uint8_t pixel(const PngPixels& image, int row, int col, int channel = 0) {
    const auto at = static_cast<std::size_t>((row * image.cols + col) * image.channels + channel);
    return image.bytes[at];
}

TEST(TrialPictureTest, TilesLieSideBySide) {
    const FrameShape shape{.rows = 2, .cols = 3, .planes = 3};
    TrialPicture picture(shape);
    std::vector<float> truth(shape.sites()), decoded(shape.sites());
    for (std::size_t i = 0; i < truth.size(); ++i) {
        truth[i] = static_cast<float>(i) / 20;
        decoded[i] = truth[i] + 0.05F;
    }
    picture.put(TrialPicture::kTruth, truth);
    picture.put(TrialPicture::kDecoded, decoded);
    picture.put_error(decoded, truth);
    const PngPixels& image = picture.pixels();
    ASSERT_EQ(image.rows, 2);
    ASSERT_EQ(image.cols, 12);
    ASSERT_EQ(image.channels, 3);
    // Row 1, column 2 of green: plane 1, so value 6 + 5.
    EXPECT_EQ(pixel(image, 1, 2, 1), tone_mapped(11.0F / 20));
    EXPECT_EQ(pixel(image, 1, 3 + 2, 1), 0);  // naive: not yet
    EXPECT_EQ(pixel(image, 1, 6 + 2, 1), tone_mapped(11.0F / 20 + 0.05F));
    EXPECT_EQ(pixel(image, 1, 9 + 2, 1), 153);  // 128 + 127 x 0.05 / 0.25 = 153.4
}

TEST(TrialPictureTest, ErrorsAreClippedAndNoneIsMiddleGrey) {
    const FrameShape shape{.rows = 1, .cols = 3, .planes = 1};
    TrialPicture picture(shape);
    picture.put_error(std::vector<float>{1, 0, -1}, std::vector<float>{0, 0, 0});
    EXPECT_EQ(pixel(picture.pixels(), 0, 9), 255);
    EXPECT_EQ(pixel(picture.pixels(), 0, 10), 128);
    EXPECT_EQ(pixel(picture.pixels(), 0, 11), 0);
}

TEST(TrialPictureTest, OfALargeFrameTheMiddleIsShown) {
    const FrameShape shape{.rows = TrialPicture::kMaxRows + 20, .cols = TrialPicture::kMaxCols + 8};
    std::vector<float> frame(shape.sites());
    frame[static_cast<std::size_t>(10 * shape.cols + 4)] = 1;  // its first pixel
    TrialPicture picture(shape);
    picture.put(TrialPicture::kTruth, frame);
    EXPECT_EQ(picture.pixels().rows, TrialPicture::kMaxRows);
    EXPECT_EQ(picture.pixels().cols, 4 * TrialPicture::kMaxCols);
    EXPECT_EQ(pixel(picture.pixels(), 0, 0), tone_mapped(1));
    EXPECT_EQ(pixel(picture.pixels(), 0, 1), 0);
}

}  // namespace
}  // namespace stipple
