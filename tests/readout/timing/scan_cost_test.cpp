#include "readout/timing/scan_cost.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "readout/schedules/tiled_schedule.h"
#include "tests/readout/timing/random_readout.h"
#include "tests/readout/timing/sensor_timing.h"

namespace stipple {
namespace {

TEST(ScanCostTest, SaysWhatTheRowsWaitFor) {
    const auto limit = [](const char* sensor, std::vector<std::string> changes, int cols) {
        const auto timing = sensor_timing(sensor, changes);
        const auto every_slot = full_schedule(1, 1);
        return ScanCosts(timing, every_slot, {200, cols, 1}).of(0).limit;
    };
    EXPECT_EQ(limit("lux1310", {}, 1280), ReadoutLimit::kLink);
    EXPECT_EQ(limit("lux1310", {"timing.settle_clocks=[200]"}, 1280), ReadoutLimit::kAdc);
    EXPECT_EQ(limit("imx273", {"timing.overhead_rows=0"}, 320), ReadoutLimit::kAdc);
    EXPECT_EQ(limit("vita", {}, 1280), ReadoutLimit::kLink);
    EXPECT_EQ(limit("vita", {}, 160), ReadoutLimit::kRowOverhead);
    EXPECT_EQ(limit("cmv4000", {}, 2048), ReadoutLimit::kRowOverhead);
}

// Deadlines that later ones do not imply: of the rows that may wait as long, the one that is done
// last counts.
TEST(ScanCostTest, DeadlinesAreThoseOfItsRows) {
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        Draw draw(seed);
        ReadoutTiming timing = random_timing(draw);
        if (draw(0, 1) == 0) {  // rows of which later ones can be done earlier
            timing.row_timing = RowTiming::kOverlapped;
            timing.columns_per_adc = timing.cols;
            timing.adc_skip = true;
            timing.adc_clocks = 20;
        }
        const FrameShape shape{draw(1, timing.rows), timing.cols, 1};
        const ExposureSchedule schedule = random_frames(draw);
        ScanCosts scans(timing, schedule, shape);
        for (std::int64_t slot = 0; slot < 20; ++slot) {
            const ScanCost cost = scans.of(slot);
            const SlotTimes times = scans.times(slot, 0);
            for (int slots = 1; slots <= schedule.period_slots(); ++slots) {
                std::int64_t expected = 0, given = 0;  // end of what must be read within `slots`
                for (const RowTimes& row : times.rows) {
                    int again = 1;
                    std::vector<RowLoad> later;
                    const auto is_row = [&](const RowLoad& load) {
                        return load.row == row.load.row;
                    };
                    const auto due_again = [&] {
                        RowLoads(timing, schedule, shape).list(slot + again, later);
                        return std::ranges::any_of(later, is_row);
                    };
                    if (row.load.row < 0) continue;
                    while (!due_again()) ++again;
                    if (again <= slots) expected = std::max(expected, row.frame_end);
                }
                for (const ScanDeadline& deadline : cost.deadlines)
                    if (deadline.slots <= slots) given = std::max(given, deadline.end);
                ASSERT_EQ(given, expected) << "seed " << seed << " slot " << slot;
            }
        }
    }
}

}  // namespace
}  // namespace stipple
