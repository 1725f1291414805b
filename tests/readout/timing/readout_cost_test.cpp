#include "readout/timing/readout_cost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "readout/program/sequencer_program.h"
#include "readout/schedules/full_schedule.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/readout/timing/random_readout.h"
#include "tests/readout/timing/sensor_timing.h"
#include "tests/readout/timing/tick_readout.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr std::uint32_t kSensors = 200;
constexpr int kSlots = 14;

/// A random sensor, a window of it and a schedule.
struct Case {
    explicit Case(std::uint32_t seed)
        : draw(seed),
          timing(random_timing(draw)),
          shape{draw(1, timing.rows), draw(1, timing.cols), draw(1, 3)},
          schedule(random_schedule(draw(1, 5), draw(1, 5), std::vector{1, 2, 4}, seed)) {
        timing.row_select_pj = 3;
        timing.conversion_pj = 5;
        timing.link_bit_pj = 0.5;
        timing.code_bit_pj = 0.25;
    }
    Draw draw;
    ReadoutTiming timing;
    FrameShape shape;
    ExposureSchedule schedule;
};

/// What the definitions say of a slot, from the reference that counts clocks.
ReadoutCounts counted_by_ticks(const Case& it, std::int64_t slot) {
    std::vector<RowLoad> loads;
    RowLoads(it.timing, it.schedule, it.shape).list(slot, loads);
    const SlotTimes times = read_slot_by_ticks(it.timing, it.shape.cols, loads, 0);
    ReadoutCounts counts;
    const auto planes = static_cast<std::uint64_t>(it.shape.planes);
    for (const RowTimes& row : times.rows) {
        const auto columns = static_cast<std::uint64_t>(row.load.columns);
        const auto all = static_cast<std::uint64_t>(it.shape.cols);
        counts.samples += planes * static_cast<std::uint64_t>(row.load.due);
        counts.transferred += planes * columns;
        counts.bits += planes * columns * static_cast<std::uint64_t>(it.timing.bits_per_sample);
        counts.conversions += planes * (it.timing.adc_skip ? columns : all);
        counts.convert_clocks += row.convert_end - row.select;
        counts.link_clocks += row.transfer_end - row.transfer;
    }
    counts.rows = static_cast<std::int64_t>(loads.size());
    counts.readout_clocks = times.end;
    counts.energy_pj =
        3.0 * static_cast<double>(counts.rows) +
        5.0 * std::exp2(it.timing.bits_per_sample - 10) * static_cast<double>(counts.conversions) +
        0.5 * static_cast<double>(counts.bits) + 0.25 * static_cast<double>(it.shape.pixels());
    return counts;
}

TEST(ReadoutCostTest, AgreesWithTheReferenceThatCountsClocks) {
    for (std::uint32_t seed = 0; seed < kSensors; ++seed) {
        const Case it(seed);
        ReadoutCost cost(it.timing, it.schedule, it.shape, {});
        std::int64_t clocks = 0;
        std::uint64_t samples = 0;
        for (int slot = 0; slot < kSlots; ++slot) {
            const ReadoutCounts expected = counted_by_ticks(it, slot);
            const SlotCost& given = cost.add_next();
            EXPECT_EQ(given.counts.samples, expected.samples);
            EXPECT_EQ(given.counts.samples,
                      count_due(it.schedule, slot, 0, it.shape.rows, it.shape.cols) *
                          static_cast<std::uint64_t>(it.shape.planes));
            EXPECT_EQ(given.counts.transferred, expected.transferred);
            EXPECT_EQ(given.counts.bits, expected.bits);
            EXPECT_EQ(given.counts.conversions, expected.conversions);
            EXPECT_EQ(given.counts.rows, expected.rows);
            EXPECT_EQ(given.counts.readout_clocks, expected.readout_clocks);
            EXPECT_EQ(given.counts.convert_clocks, expected.convert_clocks);
            EXPECT_EQ(given.counts.link_clocks, expected.link_clocks);
            EXPECT_NEAR(given.counts.energy_pj, expected.energy_pj, 1e-9);
            EXPECT_FALSE(given.overrun);
            EXPECT_EQ(given.clocks,
                      std::max({expected.readout_clocks, code_load_clocks(it.timing, it.shape.rows),
                                std::int64_t{1}}));
            clocks += given.clocks;
            samples += expected.samples;
        }
        ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed;
        EXPECT_EQ(cost.clocks(), clocks);
        EXPECT_EQ(cost.totals().samples, samples);
        EXPECT_EQ(cost.slots(), kSlots);
    }
}

TEST(ReadoutCostTest, DroppedRowsAreTheFewestThatLetTheRestFit) {
    int with_drops = 0;
    for (std::uint32_t seed = 0; seed < kSensors; ++seed) {
        Case it(seed);
        it.timing.overhead_rows = 0;
        const SlotBudget budget{
            it.timing.overhead_clocks + it.timing.code_load_clocks + it.draw(1, 60),
            OverrunPolicy::kDrop};
        ReadoutCost dropping(it.timing, it.schedule, it.shape, budget);
        for (int slot = 0; slot < kSlots; ++slot) {
            const SlotCost& given = dropping.of(slot);
            std::vector<RowLoad> loads;
            RowLoads(it.timing, it.schedule, it.shape).list(slot, loads);
            const auto all = read_slot_by_ticks(it.timing, it.shape.cols, loads, 0).rows;
            EXPECT_EQ(given.clocks, budget.clocks);
            EXPECT_LE(given.counts.readout_clocks, budget.clocks);
            EXPECT_EQ(given.overrun, given.end_row < it.shape.rows);
            for (const RowTimes& row : all) {
                const bool is_kept = row.load.row < given.end_row;
                EXPECT_TRUE(is_kept || row.end_if_last > budget.clocks) << "seed " << seed;
            }
            const auto planes = static_cast<std::uint64_t>(it.shape.planes);
            EXPECT_EQ(given.counts.samples,
                      planes * count_due(it.schedule, slot, 0, given.end_row, it.shape.cols));
            EXPECT_EQ(given.counts.samples + given.counts.dropped_samples,
                      planes * count_due(it.schedule, slot, 0, it.shape.rows, it.shape.cols));
            with_drops += given.overrun ? 1 : 0;
        }
    }
    EXPECT_GT(with_drops, 100) << "the test means something";
}

TEST(ReadoutCostTest, AStretchedSlotLastsAsLongAsItsReadout) {
    const auto timing = sensor_timing("lux1310");
    const auto every_slot = full_schedule(1, 1);
    for (const auto& [budget, overrun] : {std::pair{84142, true}, std::pair{84143, false}}) {
        ReadoutCost cost(timing, every_slot, {1024, 1280, 1}, {budget, OverrunPolicy::kStretch});
        const SlotCost& slot = cost.add_next();
        EXPECT_EQ(slot.overrun, overrun);
        EXPECT_EQ(slot.clocks, 84143);
        EXPECT_EQ(slot.end_row, 1024);
        EXPECT_EQ(cost.overruns(), overrun ? 1 : 0);
    }
}

TEST(ReadoutCostTest, TheCodeOfAWindowLoadsInTheShareOfItsRows) {
    const auto timing = sensor_timing("lux1310", {"timing.code_load_clocks=100000"});
    const auto every_slot = full_schedule(1, 1);
    for (const auto& [rows, clocks] : {std::pair{1024, 100000}, {512, 50000}, {100, 9766}}) {
        ReadoutCost cost(timing, every_slot, {rows, 16, 1}, {});
        EXPECT_EQ(cost.of(0).clocks, clocks) << "rounded up";
    }
}

TEST(ReadoutCostTest, ASlotLastsAtLeastAsLongAsTheLoadOfItsCode) {
    const auto timing = sensor_timing("lux1310", {"timing.code_load_clocks=100000"});
    const auto every_slot = full_schedule(1, 1);
    ReadoutCost cost(timing, every_slot, {1024, 1280, 1}, {});
    EXPECT_EQ(cost.of(0).clocks, 100000);
    EXPECT_EQ(cost.of(0).limit, ReadoutLimit::kCodeLoad);
}

TEST(ReadoutCostTest, SaysWhatTheRowsWaitFor) {
    const auto limit = [](const char* sensor, std::vector<std::string> changes, int cols) {
        const auto timing = sensor_timing(sensor, changes);
        const auto every_slot = full_schedule(1, 1);
        return ReadoutCost(timing, every_slot, {200, cols, 1}, {}).of(0).limit;
    };
    EXPECT_EQ(limit("lux1310", {}, 1280), ReadoutLimit::kLink);
    EXPECT_EQ(limit("lux1310", {"timing.settle_clocks=[200]"}, 1280), ReadoutLimit::kAdc);
    EXPECT_EQ(limit("imx273", {"timing.overhead_rows=0"}, 320), ReadoutLimit::kAdc);
    EXPECT_EQ(limit("vita", {}, 1280), ReadoutLimit::kLink);
    EXPECT_EQ(limit("vita", {}, 160), ReadoutLimit::kRowOverhead);
    EXPECT_EQ(limit("cmv4000", {}, 2048), ReadoutLimit::kRowOverhead);
}

TEST(ReadoutCostTest, WhatDroppingRowsCannotHelpIsRefused) {
    const auto timing = sensor_timing("imx273");
    const auto every_slot = full_schedule(1, 1);
    const auto problem = [&](std::int64_t clocks) {
        return message_of<InputError>([&] {
            ReadoutCost(timing, every_slot, {1080, 320, 1}, {clocks, OverrunPolicy::kDrop});
            return 0;
        });
    };
    expect_parts(problem(2000), {"exposure code", "7518", "slot_us"});
    expect_parts(problem(8000), {"overhead", "9919", "slot_us"});  // 319 + 40 x 240
    EXPECT_THROW(static_cast<void>(slot_clocks(timing, 0.001)), InputError);
    EXPECT_THROW(static_cast<void>(slot_clocks(timing, 1e12)), InputError);
    EXPECT_EQ(slot_clocks(timing, 1000), 74250);
}

TEST(ReadoutCostTest, ScheduleMemoryIsThatOfTheCompiledProgram) {
    const auto tiled = tiled_schedule(4, 6, std::vector{1, 2, 4, 8}, 1);
    for (const ExposureSchedule& schedule : {tiled, full_schedule(1, 4), full_schedule(4, 4)})
        EXPECT_EQ(schedule_memory_bits(schedule), compile_schedule(schedule).bits());
    EXPECT_EQ(schedule_memory_bits(tiled), 4U * 6 * 15);
}

}  // namespace
}  // namespace stipple
