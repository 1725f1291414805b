#include "capture/frame_light.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

TEST(FrameUnpackTest, RowsOfAFrameAreStrideApartAndWhatIsCutOffIsZero) {
    FrameLayout layout{
        .format = pixel_format_named("Mono12p"), .width = 2, .height = 3, .stride_bytes = 5};
    const std::vector<std::uint8_t> payload{0x23, 0x61, 0x45, 9, 9, 0x23, 0x61, 0x45, 9, 9, 0x23};
    std::vector<std::uint16_t> samples;
    unpack_frame(layout, payload, samples);
    EXPECT_EQ(samples, (std::vector<std::uint16_t>{0x123, 0x456, 0x123, 0x456, 0x023, 0}));
}

}  // namespace
}  // namespace stipple
