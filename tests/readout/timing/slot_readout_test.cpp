#include "readout/timing/slot_readout.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "readout/schedules/tiled_schedule.h"
#include "readout/timing/full_readout.h"
#include "tests/readout/timing/random_readout.h"
#include "tests/readout/timing/sensor_timing.h"
#include "tests/readout/timing/tick_readout.h"

namespace stipple {
namespace {

constexpr std::uint32_t kSensors = 3000;

/// The rows of `schedule` in `slot`, all of the array.
std::vector<RowLoad> loads_of(const ReadoutTiming& timing, const ExposureSchedule& schedule,
                              std::int64_t slot, FrameShape shape) {
    std::vector<RowLoad> loads;
    RowLoads(timing, schedule, shape).list(slot, loads);
    return loads;
}

TEST(SlotReadoutTest, EventsAndTicksAgreeOnRandomLoads) {
    for (std::uint32_t seed = 0; seed < kSensors; ++seed) {
        Draw draw(seed);
        const ReadoutTiming timing = random_timing(draw);
        ASSERT_NO_THROW(validate(timing, "random")) << "seed " << seed;
        const auto loads = random_loads(timing, draw);
        const int begin = draw(0, 1000);
        ASSERT_EQ(read_slot(timing, timing.cols, loads, begin),
                  read_slot_by_ticks(timing, timing.cols, loads, begin))
            << "seed " << seed;
    }
}

TEST(SlotReadoutTest, EventsAndTicksAgreeOnRandomSchedules) {
    for (std::uint32_t seed = 0; seed < kSensors / 10; ++seed) {
        Draw draw(seed);
        const ReadoutTiming timing = random_timing(draw);
        const FrameShape shape{draw(1, timing.rows), draw(1, timing.cols), 1};
        const auto schedule = random_schedule(draw(1, 5), draw(1, 5), std::vector{1, 2, 3}, seed);
        for (int slot = 0; slot < 10; ++slot) {
            const auto loads = loads_of(timing, schedule, slot, shape);
            ASSERT_EQ(read_slot(timing, shape.cols, loads, 0),
                      read_slot_by_ticks(timing, shape.cols, loads, 0))
                << "seed " << seed << ", slot " << slot;
        }
    }
}

TEST(SlotReadoutTest, AFullSlotTakesAsLongAsTheFormulaSays) {
    const ExposureSchedule every_slot = full_schedule(1, 1);
    for (std::uint32_t seed = 0; seed < kSensors; ++seed) {
        Draw draw(seed);
        const ReadoutTiming timing = random_timing(draw);
        const FrameShape shape{draw(1, timing.rows), draw(1, timing.cols), 1};
        const auto loads = loads_of(timing, every_slot, 0, shape);
        const UniformReadout formula = full_readout(timing, shape);
        const SlotTimes slot = read_slot(timing, shape.cols, loads, 7);
        ASSERT_EQ(slot.end - slot.begin, formula.total) << "seed " << seed;
        ASSERT_EQ(slot.settle, formula.settle) << "seed " << seed;
        const RowTimes& first = slot.rows.front();
        const bool is_sequential = timing.row_timing == RowTiming::kSequential;
        ASSERT_EQ((is_sequential ? first.select : first.transfer) - slot.begin, formula.lead)
            << "seed " << seed;
    }
}

TEST(SlotReadoutTest, NeitherTheAdcsNorTheLinkNorALatchIsEverUsedTwiceAtOnce) {
    for (std::uint32_t seed = 0; seed < kSensors; ++seed) {
        Draw draw(seed);
        const ReadoutTiming timing = random_timing(draw);
        const auto rows = read_slot(timing, timing.cols, random_loads(timing, draw), 0).rows;
        const std::size_t latches = timing.row_timing == RowTiming::kSequential ? 1 : 2;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            EXPECT_LE(rows[i].select, rows[i].convert);
            EXPECT_LE(rows[i].convert_end, rows[i].transfer);
            if (i > 0) {
                EXPECT_GE(rows[i].select, rows[i - 1].convert_end) << "seed " << seed;
                EXPECT_GE(rows[i].transfer, rows[i - 1].transfer_end) << "seed " << seed;
            }
            if (i >= latches) {
                EXPECT_GE(rows[i].select, rows[i - latches].transfer_end) << "seed " << seed;
            }
        }
    }
}

TEST(SlotReadoutTest, NothingDueTakesNoTime) {
    const auto timing = sensor_timing("lux1310");
    const SlotTimes slot = read_slot(timing, 1280, {}, 55);
    EXPECT_EQ(slot.begin, 55);
    EXPECT_EQ(slot.end, 55);
}

// Random codes: 80 columns a channel at p = 4/15 have a mean of 21.3, the largest of 16 channels is
// about 29, so a row takes about 31 clocks instead of 82 (docs/readout_timing.md).
TEST(SlotReadoutTest, RandomCodesOnLux1310TakeAbout31ClocksARow) {
    const auto timing = sensor_timing("lux1310");
    const FrameShape shape{256, 1280, 1};
    const auto schedule = random_schedule(256, 1280, kPaperExposureSlots, 1);
    const SlotTimes slot = read_slot(timing, 1280, loads_of(timing, schedule, 20, shape), 0);
    ASSERT_EQ(slot.rows.size(), 256U);
    EXPECT_NEAR(static_cast<double>(slot.end) / 256, 31, 1);
}

}  // namespace
}  // namespace stipple
