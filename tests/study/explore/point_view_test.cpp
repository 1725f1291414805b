#include "study/explore/point_view.h"

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

PointView view(const std::string& axes) {
    const Space space = parse_space("[axes]\nsensor = 'paper'\n" + axes, "space.toml");
    return view_of(space, space.point(0));
}

TEST(PointViewTest, WithoutKeysAllPixelsAreRead) {
    EXPECT_TRUE(view("").is_whole());
    EXPECT_EQ(view("").binned(view("").window({5, 7, 3})), (FrameShape{5, 7, 3}));
}

TEST(PointViewTest, AWindowIsInTheMiddleAndIsThenBinned) {
    const PointView part = view("binning = 2\nbinning_mode = 'charge'\nwindow_rows = 0.5\n");
    EXPECT_EQ(part.mode, BinningMode::kCharge);
    EXPECT_EQ(part.window({8, 4, 1}), (FrameShape{4, 4, 1}));
    EXPECT_EQ(part.binned({4, 4, 1}), (FrameShape{2, 2, 1}));
    FluxVideo light(1, {8, 4, 1});
    for (int row = 0; row < 8; ++row)
        for (int col = 0; col < 4; ++col)
            light.plane(0, 0)(row, col) = static_cast<float>(10 * row + col);
    const FluxVideo window = window_light(light, part);
    EXPECT_EQ(window.frame(0).front(), 20);  // rows 2 to 5
    EXPECT_EQ(window.frame(0).back(), 53);
    const FluxVideo sums = binned_light(window, part);
    EXPECT_EQ(std::vector<float>(sums.data().begin(), sums.data().end()),
              (std::vector<float>{25.5, 27.5, 45.5, 47.5}));
}

TEST(PointViewTest, ValuesThatCannotBeAreRefused) {
    const auto refusal = [](const std::string& axes) {
        return message_of<InputError>([&] { (void)view(axes); });
    };
    expect_parts(refusal("binning = 9\n"), {"binning", "\"9\" is not a whole number from 1 to 8"});
    expect_parts(refusal("binning_mode = 'sum'\n"), {"binning_mode", "charge, voltage"});
    for (const char* rows : {"0", "1.5", "'half'"})
        expect_parts(refusal(std::string("window_rows = ") + rows + "\n"),
                     {"window_rows", "above 0 and up to 1"});
    expect_parts(refusal("binning = 2\nrig = 'flutter'\n"), {"binning", "rig"});
    FluxVideo odd(1, {5, 6, 1});
    expect_parts(message_of<InputError>([&] { (void)binned_light(odd, view("binning = 2\n")); }),
                 {"6 x 5 pixels", "not a multiple"});
}

}  // namespace
}  // namespace stipple
