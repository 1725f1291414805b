#include "study/report/report_window.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/error.h"

namespace stipple {
namespace {

constexpr FrameShape kFrame{.rows = 4, .cols = 6, .planes = 3};

TEST(ReportWindowTest, AnAreaIsWidthHeightColumnRow) {
    EXPECT_EQ(parse_area("32x24+5+7"),
              (PixelArea{.first_row = 7, .first_col = 5, .rows = 24, .cols = 32}));
    EXPECT_EQ(parse_area("32x24"), (PixelArea{.rows = 24, .cols = 32}));
}

TEST(ReportWindowTest, OtherTextsAreNoArea) {
    for (const char* text : {"", "32", "32x", "32x24+", "32x24+5", "32x24+5+", "32x24+5+7+9",
                             "0x24", "32x0", "-1x5", "32x24-5+7", "ax5", "32x24 ", "99999999999x1"})
        EXPECT_EQ(parse_area(text), std::nullopt) << text;
}

TEST(ReportWindowTest, WithoutAWishTheMiddleIsShown) {
    EXPECT_EQ(report_area(kFrame, {}), (PixelArea{.rows = 4, .cols = 6}));
    EXPECT_EQ(report_area({.rows = 1000, .cols = 2000, .planes = 1}, {}),
              (PixelArea{.first_row = 260, .first_col = 680, .rows = 480, .cols = 640}));
}

TEST(ReportWindowTest, TheMiddleIsNoLargerThanTheFrame) {
    EXPECT_EQ(middle_area(kFrame, 2, 3),
              (PixelArea{.first_row = 1, .first_col = 1, .rows = 2, .cols = 3}));
    EXPECT_EQ(middle_area(kFrame, 9, 2), (PixelArea{.first_col = 2, .rows = 4, .cols = 2}));
}

TEST(ReportWindowTest, AnAreaOutsideTheFrameIsRefused) {
    for (const char* text : {"7x4", "6x5", "6x4+1+0", "6x4+0+1", "1x1+2147483647+0"})
        EXPECT_THROW((void)report_area(kFrame, parse_area(text)), InputError) << text;
    EXPECT_EQ(report_area(kFrame, parse_area("1x1+5+3")), *parse_area("1x1+5+3"));
}

TEST(ReportWindowTest, CroppedValuesKeepTheirOrder) {
    std::vector<float> frame(kFrame.sites());
    for (std::size_t i = 0; i < frame.size(); ++i) frame[i] = static_cast<float>(i);
    // Two rows of three columns from (1, 2) on; a plane has 24 values.
    EXPECT_EQ(
        cropped(frame, kFrame, *parse_area("3x2+2+1")),
        (std::vector<float>{8, 9, 10, 14, 15, 16, 32, 33, 34, 38, 39, 40, 56, 57, 58, 62, 63, 64}));
}

}  // namespace
}  // namespace stipple
