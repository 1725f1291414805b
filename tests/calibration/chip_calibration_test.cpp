#include "calibration/chip_calibration.h"

#include <gtest/gtest.h>

#include <cmath>

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
    expect_refused(other, header(), {}, "8 x 4 pixels in 1 plane, and the stream has 6 x 4 in 1");
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

TEST(ChipCalibrationTest, FiguresAreThoseOfTheStoredMapsWithoutDefects) {
    ChipCalibration ours = calibration();
    const SiteCalibration low{.gain = 0.75F,
                              .gain_variance = 0.0625F,
                              .offset_dn = 60,
                              .dark_dn_per_s = 10,
                              .readout_noise_dn2 = 4};
    const SiteCalibration high{.gain = 1.25F,
                               .gain_variance = 0.1875F,
                               .offset_dn = 68,
                               .dark_dn_per_s = 30,
                               .readout_noise_dn2 = 6};
    ours.sites = {low, {.gain = 7, .gain_variance = 9, .offset_dn = 900, .defect = true}, high};
    const ChipFigures figures = chip_figures(ours);
    EXPECT_EQ(figures.gain.mean, 1);
    EXPECT_EQ(figures.gain.deviation, 0.25);
    EXPECT_EQ(figures.gain_error, std::sqrt(0.125));
    EXPECT_EQ(figures.offset_dn.mean, 64);
    EXPECT_EQ(figures.offset_dn.deviation, 4);
    EXPECT_EQ(figures.dark_dn_per_s.deviation, 10);
    EXPECT_EQ(figures.readout_noise_dn2.mean, 5);
    EXPECT_EQ(figures.defects, 1U);
}

}  // namespace
}  // namespace stipple
