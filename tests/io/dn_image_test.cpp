#include "io/image_file.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

const std::vector<std::uint16_t> kValues{0, 1, 255, 256, 4095, 65535};
constexpr FrameShape kShape{.rows = 2, .cols = 3, .planes = 1};

TEST(DnImageTest, ReadsTheNumbersThatItWrites) {
    const TemporaryFolder folder;
    write_dn_png(folder / "a.png", "a.png", kShape, kValues);
    const DnImage image = read_dn_image(folder / "a.png");
    EXPECT_EQ(image.shape, kShape);
    EXPECT_EQ(image.dn, kValues);
    // As another program reads it.
    const cv::Mat other = cv::imread((folder / "a.png").string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(other.type(), CV_16UC1);
    EXPECT_EQ(other.at<std::uint16_t>(1, 1), 4095);
}

TEST(DnImageTest, DoesNotScaleEightBits) {
    const TemporaryFolder folder;
    const cv::Mat image = (cv::Mat_<std::uint8_t>(1, 3) << 0, 7, 255);
    for (const char* name : {"a.png", "a.tif"}) {
        cv::imwrite((folder / name).string(), image);
        EXPECT_EQ(read_dn_image(folder / name).dn, (std::vector<std::uint16_t>{0, 7, 255})) << name;
    }
}

TEST(DnImageTest, RefusesWhatHoldsNoDigitalNumbersByName) {
    const TemporaryFolder folder;
    cv::imwrite((folder / "colour.png").string(), cv::Mat::zeros(2, 2, CV_8UC3));
    write_text(folder / "broken.png", "no image");
    const auto refuse = [&](const char* name, const std::vector<std::string>& parts) {
        expect_parts(message_of<InputError>([&] { return read_dn_image(folder / name); }), parts);
    };
    refuse("colour.png", {"colour.png", "not grey"});
    cv::imwrite((folder / "bits.png").string(), cv::Mat::ones(2, 8, CV_8UC1),
                {cv::IMWRITE_PNG_BILEVEL, 1});
    refuse("bits.png", {"bits.png", "is not grey with 8 or 16 bits"});
    refuse("broken.png", {"broken.png"});
    refuse("missing.png", {"missing.png"});
    refuse("video.mp4", {"video.mp4", "PNG or TIFF"});
}

}  // namespace
}  // namespace stipple
