#include "readout/schedules/volume_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

TEST(MaskScheduleTest, GivesEachPixelTheExposureOfItsMask) {
    // Layers of one row of three pixels.
    const NpyVolume masks{4, 1, 3, {0, 1, 0, /**/ 1, 0, 0, /**/ 0, 0, 0, /**/ 1, 1, 0}};
    EXPECT_EQ(mask_schedule(masks, ""),
              ExposureSchedule(1, 3, 4, {0, 1, 2, 2}, {{1, 0b101}, {0, 0b1001}}));
}

TEST(MaskScheduleTest, GreyMasksAreWeights) {
    const NpyVolume masks{2, 1, 3, {0.5, 1, 0, /**/ 0.25, 1e-7, 2}};
    const ExposureSchedule schedule = mask_schedule(masks, "");
    EXPECT_TRUE(
        std::ranges::equal(schedule.weights(), std::vector<float>{0.5F, 1, 0, /**/ 0.25F, 0, 2}));
    EXPECT_EQ(schedule.exposures(0, 1)[0], (Exposure{0, 1}));  // 1e-7 is closed
    EXPECT_EQ(schedule.exposures(0, 2)[0], (Exposure{1, 1}));
}

// Whole numbers above 1 are those of an image; 51 is a fifth of white, and 13107 of 16 bits.
TEST(MaskScheduleTest, MasksOfAnImageAreWhiteAtFullScale) {
    EXPECT_EQ(mask_schedule({1, 1, 2, {0, 13107}}, "").weights()[1], 0.2F);
    EXPECT_EQ(mask_schedule({1, 1, 2, {0, 51}}, "").weights()[1], 0.2F);
    EXPECT_FALSE(mask_schedule({1, 1, 2, {0, 255}}, "").weighted());
    EXPECT_FALSE(mask_schedule({1, 1, 2, {0, 1}}, "").weighted());
    EXPECT_EQ(mask_schedule({1, 1, 2, {0.5, 1.5}}, "").weights()[1], 1.5F);
    EXPECT_EQ(mask_schedule({1, 1, 2, {0, 51}}, "", 102).weights()[1], 0.5F);
}

TEST(MaskScheduleTest, NamesPixelAndSlotOfWhatIsNoMask) {
    for (const double bad : {-0.5, std::nan(""), static_cast<double>(INFINITY), 1e7}) {
        const NpyVolume masks{2, 2, 1, {0, 1, 0.5, bad}};
        expect_parts(message_of<InputError>([&] { return mask_schedule(masks, "m.npy"); }),
                     {"m.npy", "pixel (1, 0) slot 1", "is not a weight: it is outside 0..1048576"});
    }
    expect_parts(message_of<InputError>([] {
                     return mask_schedule({1, 1, 2, {0, 0}}, "m.npy");
                 }),
                 {"m.npy: all weights are 0"});
    NpyVolume wide{66, 1, 1, std::vector<double>(66, 0)};
    wide.values[1] = wide.values[64] = 1;
    EXPECT_EQ(mask_schedule(wide, "").exposures(0, 0)[0].span_slots(), 64);
    wide.values[65] = 1;
    expect_parts(message_of<InputError>([&] { return mask_schedule(wide, ""); }),
                 {"pixel (0, 0) slot 65", "slot 1 on", "64"});
}

TEST(LengthsScheduleTest, PutsExposuresOneAfterTheOther) {
    const NpyVolume lengths{2, 1, 3, {2, 0, 0, /**/ 1, 4, 0}};
    const std::vector<Exposure> exposures = {{0, 0b11}, {2, 1}, {0, 0b1111}};
    EXPECT_EQ(lengths_schedule(lengths, 0, ""), ExposureSchedule(1, 3, 4, {0, 2, 3, 3}, exposures));
    EXPECT_EQ(lengths_schedule(lengths, 9, "").period_slots(), 9);
}

TEST(LengthsScheduleTest, NamesPixelAndExposureOfWhatDoesNotFit) {
    const NpyVolume odd{1, 1, 2, {1, 1.5}};
    expect_parts(message_of<InputError>([&] { return lengths_schedule(odd, 0, "l.npy"); }),
                 {"l.npy", "pixel (0, 1) exposure 0", "1.5", "0 to 64"});
    const NpyVolume late{2, 1, 1, {3, 4}};
    expect_parts(message_of<InputError>([&] { return lengths_schedule(late, 6, ""); }),
                 {"pixel (0, 0) exposure 1", "7 slots", "period is 6"});
    const NpyVolume endless{1100, 1, 1, std::vector<double>(1100, 64)};
    expect_parts(message_of<InputError>([&] { return lengths_schedule(endless, 0, ""); }),
                 {"exposure 1023", "65536", "65535"});
}

}  // namespace
}  // namespace stipple
