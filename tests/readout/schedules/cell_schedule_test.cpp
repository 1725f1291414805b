#include "readout/schedules/cell_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

TEST(CellScheduleTest, RepeatsEachPixelAtItsOwnRate) {
    const Cell cell{.rows = 1,
                    .cols = 2,
                    .exposure_slots = {1, 2},
                    .every_slots = {2, 3},
                    .first_slots = {1, 2}};
    const ExposureSchedule expected(1, 2, 6, {0, 3, 5},
                                    {{1, 1}, {3, 1}, {5, 1}, {2, 0b11}, {5, 0b11}});
    EXPECT_EQ(cell_schedule(cell), expected);
}

TEST(CellScheduleTest, NamesThePixelWhoseExposureDoesNotFit) {
    expect_parts(message_of<InputError>([] {
                     return cell_schedule({1, 2, {4, 5}, {4, 4}, {0, 3}});
                 }),
                 {"pixel (0, 1) slot 3", "5 slots every 4"});
}

TEST(CellScheduleTest, RefusesPeriodsBeyondTheFormat) {
    expect_parts(message_of<InputError>([] {
                     return cell_schedule({1, 2, {1, 1}, {256, 257}, {0, 0}});
                 }),
                 {"65792", "65535"});
    // 4095 pixels with 4096 exposures in the period, 4096 pixels with one: 2^24.
    Cell most{8191, 1, std::vector<int>(8191, 1), std::vector<int>(8191, 1),
              std::vector<int>(8191, 0)};
    std::fill_n(most.every_slots.rbegin(), 4096, 4096);
    most.exposure_slots[0] = 2;  // the next fault, found before anything is made
    expect_parts(message_of<InputError>([&] { return cell_schedule(most); }), {"pixel (0, 0)"});
    Cell more{8192, 1, most.exposure_slots, most.every_slots, most.first_slots};
    more.exposure_slots.push_back(1);
    more.every_slots.push_back(4096);
    more.first_slots.push_back(0);
    expect_parts(message_of<InputError>([&] { return cell_schedule(more); }), {"2^24 fit"});
}

TEST(RollingScheduleTest, StartsRowAfterRow) {
    const ExposureSchedule rolling = rolling_schedule({2, 3, 2}, 100);
    EXPECT_EQ(rolling.tile_rows(), 6);  // two rows a slot, three slots a period
    for (int row = 0; row < 6; ++row) {
        ASSERT_EQ(rolling.exposures(row, 0).size(), 1U);
        EXPECT_EQ(rolling.exposures(row, 0)[0],
                  (Exposure{static_cast<std::uint32_t>(row / 2), 0b11}));
    }
    EXPECT_EQ(rolling_schedule({2, 3, 2}, 5).tile_rows(), 5);
}

TEST(RollingScheduleTest, RefusesWhatNoShutterDoes) {
    for (const RollingShutter& wrong :
         {RollingShutter{0, 3, 1}, RollingShutter{65, 100, 1}, RollingShutter{4, 3, 1},
          RollingShutter{1, 65536, 1}, RollingShutter{1, 3, 0}})
        EXPECT_THROW(static_cast<void>(rolling_schedule(wrong, 10)), InputError);
}

}  // namespace
}  // namespace stipple
