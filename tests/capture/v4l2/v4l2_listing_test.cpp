// Emulated ioctl: which nodes are cameras, and what is wrong with them.
#include "capture/v4l2/v4l2_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/capture/v4l2/emulated_v4l2.h"

namespace stipple {
namespace {

using testing::HasSubstr;
using Level = DoctorFinding::Level;

TEST(V4l2ListingTest, ListsCameras) {
    const EmulatedV4l2 emulated;
    const auto cameras = list_v4l2_cameras();
    ASSERT_EQ(cameras.size(), 1);
    EXPECT_EQ(cameras[0].address, "v4l2:/dev/video0");
    EXPECT_EQ(cameras[0].transport, "V4L2");
    EXPECT_EQ(cameras[0].vendor, "emulated");
    EXPECT_EQ(cameras[0].model, "Emulated camera");
}

TEST(V4l2ListingTest, LeavesOutNodesThatDoNotCapture) {
    EmulatedDriver driver;
    driver.capabilities = 0;  // no streaming
    const EmulatedV4l2 emulated(driver);
    EXPECT_TRUE(list_v4l2_cameras().empty());
    const auto findings = v4l2_findings();
    ASSERT_EQ(findings.size(), 1);
    EXPECT_EQ(findings[0].level, Level::kGood);
}

TEST(V4l2ListingTest, TheDoctorNamesTheFormats) {
    EmulatedDriver driver;
    driver.formats = {V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_Y16};
    const EmulatedV4l2 emulated(driver);
    const auto findings = v4l2_findings();
    ASSERT_EQ(findings.size(), 1);
    EXPECT_EQ(findings[0].subject, "v4l2:/dev/video0");
    EXPECT_EQ(findings[0].level, Level::kGood);
    EXPECT_THAT(findings[0].fact, HasSubstr("sends Mono8, Mono16"));
}

TEST(V4l2ListingTest, TheDoctorWarnsOfCamerasWithoutRawFormats) {
    EmulatedDriver driver;
    driver.formats = {V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_MJPEG};
    const EmulatedV4l2 emulated(driver);
    const auto findings = v4l2_findings();
    ASSERT_EQ(findings.size(), 1);
    EXPECT_EQ(findings[0].level, Level::kWarning);
    EXPECT_THAT(findings[0].fix, HasSubstr("--list-formats-ext"));
}

}  // namespace
}  // namespace stipple
