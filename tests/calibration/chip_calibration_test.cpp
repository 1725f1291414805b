#include "calibration/chip_calibration.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

StreamHeader header() {
    return {.shape = {.rows = 4, .cols = 6, .planes = 1},
            .calibration = {.bit_depth = 12},
            .schedule = {1, 1, 1, {0, 1}, {{0, 1}}},
            .schedule_source = {},
            .schedule_name = "",
            .provenance = ""};
}

ChipCalibration calibration() {
    return {.shape = FrameShape{.rows = 4, .cols = 6, .planes = 1},
            .bit_depth = 12,
            .chip = ChipIdentity{.name = "t6", .device_id = 1},
            .sites = std::vector<SiteCalibration>(24)};
}

void expect_refused(const ChipCalibration& ours, const StreamHeader& stream,
                    const ChipIdentity& chip, const std::string& part) {
    expect_parts(
        message_of<InputError>([&] { require_same_chip(ours, stream, chip, "chip.stcal"); }),
        {"chip.stcal", part});
}

TEST(ChipCalibrationTest, TheSameChipIsAccepted) {
    EXPECT_NO_THROW(require_same_chip(calibration(), header(), {}, "chip.stcal"));
    EXPECT_NO_THROW(
        require_same_chip(calibration(), header(), {.name = "t6", .device_id = 1}, "chip.stcal"));
}

TEST(ChipCalibrationTest, AnotherChipIsRefused) {
    expect_refused(calibration(), header(), {.name = "t6", .device_id = 2},
                   "the chip with device_id 1, and the stream of 2");
    expect_refused(calibration(), header(), {.name = "t7"}, "\"t6\", and the stream of \"t7\"");
    ChipCalibration other = calibration();
    other.shape.cols = 8;
    expect_refused(other, header(), {}, "8 x 4 pixels in 1 planes, and the stream has 6 x 4 in 1");
    other = calibration();
    other.bit_depth = 10;
    expect_refused(other, header(), {}, "10 bits, and the stream has 12 bits");
    other = calibration();
    other.cfa = ColourFilter::kRggb;
    expect_refused(other, header(), {}, "colour filter array");
    StreamHeader mosaic = header();
    mosaic.calibration.tile = {1, 1, {{}}};
    expect_refused(calibration(), mosaic, {}, "tile of 0 x 0");
}

}  // namespace
}  // namespace stipple
