#include "io/image_file.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "io/tone_map.h"
#include "tests/io/test_images.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

TEST(ToneMapTest, KeepsHighlightsOfTwiceTheNominalWhiteApart) {
    // 255 (x (1 + x/16) / (1 + x))^(1/2.2) by hand.
    EXPECT_EQ(tone_mapped(0), 0);
    EXPECT_EQ(tone_mapped(0.18F), 109);
    EXPECT_EQ(tone_mapped(1), 191);
    EXPECT_EQ(tone_mapped(2), 224);
    EXPECT_EQ(tone_mapped(4), 255);
    EXPECT_EQ(tone_mapped(1e30F), 255);
}

TEST(ToneMapTest, IsMonotonic) {
    for (int i = 0; i < 5000; ++i)
        EXPECT_LE(tone_mapped(0.001F * static_cast<float>(i)),
                  tone_mapped(0.001F * static_cast<float>(i + 1)));
}

TEST(ToneMapTest, ShowsWhatIsNoLightAsBlackAndInfinityAsWhite) {
    EXPECT_EQ(tone_mapped(std::nanf("")), 0);
    EXPECT_EQ(tone_mapped(-1), 0);
    EXPECT_EQ(tone_mapped(HUGE_VALF), 255);
}

TEST(ImageFileTest, WritesToneMappedMonoAndColour) {
    const TemporaryFolder folder;
    write_png(folder / "mono.png", "mono.png", {1, 2, 1}, std::vector<float>{1, 0});
    const cv::Mat mono = cv::imread((folder / "mono.png").string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(mono.type(), CV_8UC1);
    EXPECT_EQ(mono.at<std::uint8_t>(0, 0), 191);
    EXPECT_EQ(mono.at<std::uint8_t>(0, 1), 0);
    write_png(folder / "rgb.png", "rgb.png", {1, 1, 3}, std::vector<float>{2, 1, 0});
    const cv::Mat rgb = cv::imread((folder / "rgb.png").string(), cv::IMREAD_UNCHANGED);
    EXPECT_EQ(rgb.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 191, 224));
}

TEST(ImageFileTest, ReportsAImageThatCannotBeWritten) {
    const TemporaryFolder folder;
    expect_parts(message_of<DeviceError>([&] {
                     write_png(folder / "no/f.png", "no/f.png", {1, 1, 1}, std::vector<float>{1});
                 }),
                 {"no/f.png: cannot be written: No such file"});
}

TEST(ImageFileTest, ReadsFloatTiff) {
    const TemporaryFolder folder;
    write_flat(folder / "f.tiff", 2, 1, CV_32FC1, 7.25);
    Image image;
    read_image(folder / "f.tiff", image);
    EXPECT_EQ(image.values, (std::vector<float>{7.25F, 7.25F}));
}

TEST(ImageFileTest, RefusesAnotherPixelTypeOrFormat) {
    const TemporaryFolder folder;
    Image image;
    write_flat(folder / "f.tiff", 2, 1, CV_64FC1, 7.25);
    expect_parts(message_of<InputError>([&] { read_image(folder / "f.tiff", image); }),
                 {"f.tiff: holds samples of 64 bits (float); give 8- or 16-bit"});
    expect_parts(message_of<InputError>([&] { read_image(folder / "f.jpg", image); }),
                 {"f.jpg: is not an image that can be read"});
}

}  // namespace
}  // namespace stipple
