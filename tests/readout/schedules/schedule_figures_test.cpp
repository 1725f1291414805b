#include "readout/schedules/schedule_figures.h"

#include <gtest/gtest.h>

#include "readout/program/sequencer_program.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 32, .cols = 48, .planes = 3};

TEST(ScheduleFiguresTest, AnEvenTileHasTheFiguresOfTheClosedForm) {
    // 6 tiles of 16 x 16, 1024 exposures in 15 slots: 68 or 69 are read in each
    // (docs/schedules.md).
    const auto figures = schedule_figures(tiled_schedule(16, 16, kPaperExposureSlots, 1), kShape);
    EXPECT_EQ(figures.period_slots, 15);
    EXPECT_DOUBLE_EQ(figures.compression_ratio, 3.75);
    EXPECT_EQ(figures.light_throughput, 1);
    EXPECT_EQ(figures.min_exposures, 4);
    EXPECT_EQ(figures.max_exposures, 4);
    EXPECT_EQ(figures.min_due, 6U * 68);
    EXPECT_EQ(figures.max_due, 6U * 69);
    EXPECT_DOUBLE_EQ(figures.mean_due, 6 * 1024 / 15.0);
    EXPECT_EQ(figures.code_memory_bits, 16U * 16 * 15);
}

TEST(ScheduleFiguresTest, MemoryIsThatOfTheCompiledSchedule) {
    for (const auto& schedule :
         {tiled_schedule(8, 8, kPaperExposureSlots, 1), gapped_schedule(3, 5, 29, 1),
          full_schedule(1, 4), interleaved_schedule(3, 5, 9, 1)})
        EXPECT_EQ(schedule_figures(schedule, kShape).code_memory_bits,
                  compile_schedule(schedule).bits());
}

TEST(ScheduleFiguresTest, PixelsThatAreNeverReadHaveNoExposures) {
    const auto figures = schedule_figures({1, 2, 4, {0, 1, 1}, {{0, 1}}}, kShape);
    EXPECT_EQ(figures.min_exposures, 0);
    EXPECT_EQ(figures.min_due, 0U);
    EXPECT_EQ(figures.max_due, 32U * 24);
    EXPECT_EQ(figures.compression_ratio, 8);
}

}  // namespace
}  // namespace stipple
