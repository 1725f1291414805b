#include "readout/measured_stream.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"
#include "readout/schedules/volume_schedule.h"
#include "stream/stream_reader.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

/// Two measurements of three pixels by masks of three slots; the last pixel is never open.
MeasuredArrays arrays() {
    return {.measurements = {2, 1, 3, {1.5, -0.25, 9, /**/ 3, 0.75, std::nan("")}},
            .masks = {3, 1, 3, {1, 0, 0, /**/ 0.5, 0, 0, /**/ 0, 0.25, 0}},
            .measurement_file = "y.npy",
            .mask_file = "m.npy",
            .light = 1};
}

std::string problem_of(const MeasuredArrays& wrong) {
    const TemporaryFolder folder;
    return message_of<InputError>([&] { import_measurements(wrong, folder / "a.stipple", false); });
}

// Light by the formula of docs/stream_format.md; a sample is exact to half of 1/65533 of the range.
TEST(MeasuredStreamTest, EachMeasurementIsTheSampleOfItsLastOpenSlot) {
    const TemporaryFolder folder;
    const ImportedStream made = import_measurements(arrays(), folder / "a.stipple", false);
    EXPECT_EQ(made.unread_pixels, 1U);
    StreamReader reader(folder / "a.stipple", ReadPolicy::kStrict);
    EXPECT_EQ(reader.header(), made.header);
    EXPECT_EQ(reader.header().schedule.weight(1, 0, 0), 0.5F);
    const Calibration& c = reader.header().calibration;
    EXPECT_TRUE(c.noise_free);
    std::vector<std::pair<std::int64_t, double>> lights;  // by slot
    for (SamplePacket packet; reader.next(packet);)
        for (const std::uint16_t dn : packet.dn) {
            EXPECT_TRUE(dn > 0 && dn < 65535) << "clipped";
            lights.emplace_back(packet.slot,
                                (dn - c.black_level_dn) * c.gain_e_per_dn / c.electrons_per_unit);
        }
    EXPECT_EQ(reader.report().slots, 6);
    const std::vector<std::pair<std::int64_t, double>> expected = {
        {1, 1.5}, {2, -0.25}, {4, 3}, {5, 0.75}};
    ASSERT_EQ(lights.size(), expected.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        EXPECT_EQ(lights[i].first, expected[i].first);
        EXPECT_NEAR(lights[i].second, expected[i].second, 0.51 * 3.25 / 65533);
    }
}

TEST(MeasuredStreamTest, ElectronsAndSaturationBecomeTheCalibration) {
    MeasuredArrays y = arrays();
    y.light = 2;
    y.electrons = 500;
    y.read_noise_e = 3;
    y.saturation = 2.5;
    const TemporaryFolder folder;
    const Calibration c = import_measurements(y, folder / "a.stipple", false).header.calibration;
    EXPECT_FALSE(c.noise_free);
    EXPECT_EQ(c.electrons_per_unit, 500);
    EXPECT_EQ(c.read_noise_e, 3);
    EXPECT_DOUBLE_EQ(c.full_well_e, 500 * 2.5 / 2);
    EXPECT_DOUBLE_EQ(c.gain_e_per_dn, 500 * 3.25 / 65533 / 2);
}

TEST(MeasuredStreamTest, TheUnitIs255WhereLightWouldBeAbove1) {
    const ExposureSchedule schedule = mask_schedule(arrays().masks, "");
    EXPECT_EQ(light_of({1, 1, 3, {1.5, 0.25, 9}}, schedule), 1);
    EXPECT_EQ(light_of({1, 1, 3, {1.5, 0.26, 9}}, schedule), 255);
}

TEST(MeasuredStreamTest, NamesWhatIsWrong) {
    MeasuredArrays wrong = arrays();
    wrong.measurements = {1, 3, 2, std::vector<double>(6, 1)};
    expect_parts(problem_of(wrong),
                 {"y.npy", "1 measurements of 3 x 2", "3 masks of m.npy", "1 x 3"});
    wrong = arrays();
    wrong.measurements.values[3] = HUGE_VAL;
    expect_parts(problem_of(wrong), {"y.npy", "measurement 1 pixel (0, 0)", "inf is not a number"});
    wrong = arrays();
    wrong.masks.values[7] = -0.25;
    expect_parts(problem_of(wrong), {"m.npy", "pixel (0, 1) slot 2", "-0.25 is not a weight"});
    wrong = arrays();
    wrong.measurements.values = {0, -1, 9, 0, 0, 9};
    expect_parts(problem_of(wrong), {"y.npy", "no measurement is above 0"});
}

}  // namespace
}  // namespace stipple
