#include "sensor_model/slot_light.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

namespace stipple {
namespace {

TEST(ColourMosaicTest, NamesReadAsTheCellIs) {
    for (const ColourFilter filter :
         {ColourFilter::kRggb, ColourFilter::kGrbg, ColourFilter::kGbrg, ColourFilter::kBggr}) {
        std::string cell;
        for (int row = 0; row < 2; ++row)
            for (int col = 0; col < 2; ++col)
                cell += "rgb"[static_cast<std::size_t>(colour_plane(filter, row, col))];
        EXPECT_EQ(cell, name_of(filter));
    }
}

TEST(ColourMosaicTest, EachPixelSeesThePlaneOfItsFilter) {
    const FrameShape shape{.rows = 3, .cols = 5, .planes = 3};
    std::vector<float> frame(shape.sites()), mosaic(shape.pixels());
    std::iota(frame.begin(), frame.end(), 0.0F);
    take_mosaic(ColourFilter::kGrbg, shape, frame, mosaic);
    const std::vector<float> expected{15, 1, 17, 3, 19, 35, 21, 37, 23, 39, 25, 11, 27, 13, 29};
    EXPECT_EQ(mosaic, expected);
}

}  // namespace
}  // namespace stipple
