#include "capture/serve/served_frames.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

/// Frames of a camera with a colour filter array, which have one plane.
TEST(CodedFramesTest, ServesAMosaicThroughASensorWithTheSameFilters) {
    const TemporaryFolder folder;
    write_text(folder / "clip.raw", std::string(std::size_t{3} * 8 * 8, 'x'));
    const FootageOrigin origin{
        .reading = {.max_value = {}, .raw = parse_raw_format("8x8:bayergb8")}};
    const SensorChoice sensor{.settings = {"mode=physical", "cfa=gbrg"}};
    CodedFrames frames(folder / "clip.raw", origin, sensor, {});
    frames.start({});
    int count = 0;
    while (frames.next()) ++count;
    EXPECT_EQ(count, 3);
}

}  // namespace
}  // namespace stipple
