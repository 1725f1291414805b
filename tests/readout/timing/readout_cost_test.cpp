#include "readout/timing/readout_cost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/schedule_parts.h"
#include "readout/program/sequencer_program.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/readout/timing/random_readout.h"
#include "tests/readout/timing/sensor_timing.h"
#include "tests/readout/timing/tick_chip.h"
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

TEST(ReadoutCostTest, CountsAreThoseOfTheReferenceThatCountsClocks) {
    for (std::uint32_t seed = 0; seed < kSensors; ++seed) {
        const Case it(seed);
        ReadoutCost cost(it.timing, it.schedule, it.shape, {});
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
            samples += expected.samples;
        }
        ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed;
        EXPECT_EQ(cost.totals().samples, samples);
        EXPECT_EQ(cost.slots(), kSlots);
    }
}

// Frames, several lengths, gaps; sensors that expose while they read, and others.
TEST(ReadoutCostTest, SlotsAreAsLongAsOnAChipThatCountsClocks) {
    int waiting = 0, stretched = 0;
    for (std::uint32_t seed = 0; seed < 1000; ++seed) {
        Draw draw(seed);
        ReadoutTiming timing = random_timing(draw);
        timing.exposes_while_reading = draw(0, 3) > 0;
        const FrameShape shape{draw(1, timing.rows), timing.cols, 1};
        const ExposureSchedule schedule = random_frames(draw);
        const std::int64_t budget = draw(0, 3) * draw(1, 40);
        const auto expected = slot_lengths_by_ticks(timing, std::vector{SchedulePart{&schedule}},
                                                    shape, budget, 2 * kSlots);
        ReadoutCost cost(timing, schedule, shape, {budget, OverrunPolicy::kStretch});
        std::int64_t clocks = 0;
        for (const std::int64_t length : expected) {
            const SlotCost& slot = cost.add_next();
            EXPECT_EQ(slot.begin, clocks);
            EXPECT_EQ(slot.clocks, length);
            EXPECT_EQ(slot.overrun, budget > 0 && length > budget);
            EXPECT_EQ(slot.end_row, shape.rows);
            waiting += slot.scan_begin > slot.begin ? 1 : 0;
            stretched += slot.overrun ? 1 : 0;
            clocks += length;
        }
        EXPECT_EQ(cost.clocks(), clocks);
        ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed;
    }
    EXPECT_GT(waiting, 1000) << "the test means something";
    EXPECT_GT(stretched, 1000) << "the test means something";
}

TEST(ReadoutCostTest, AtASwitchNoRowWaitsAsOnAChipThatCountsClocks) {
    int stretched = 0;
    for (std::uint32_t seed = 0; seed < 1000; ++seed) {
        Draw draw(seed);
        ReadoutTiming timing = random_timing(draw);
        timing.exposes_while_reading = draw(0, 3) > 0;
        const FrameShape shape{draw(1, timing.rows), timing.cols, 1};
        const ExposureSchedule first = random_frames(draw), second = random_frames(draw);
        const SlotBudget budget{draw(0, 3) * draw(1, 40), OverrunPolicy::kStretch};
        const std::vector<SchedulePart> parts{{&first}, {&second, draw(1, kSlots)}};
        const auto expected =
            slot_lengths_by_ticks(timing, parts, shape, budget.clocks, 2 * kSlots);
        ReadoutCost cost(timing, first, shape, budget);
        for (std::int64_t slot = 0; slot < 2 * kSlots; ++slot) {
            SlotCost given = cost.add_next();
            if (slot + 1 == parts[1].first_slot) {
                const std::int64_t before = given.clocks;
                given = cost.before_switch(second);
                cost.switch_to(second);
                stretched += given.clocks > before ? 1 : 0;
                EXPECT_EQ(given.begin + given.clocks, cost.clocks());
            }
            EXPECT_EQ(given.clocks, expected[static_cast<std::size_t>(slot)]) << slot;
            EXPECT_EQ(given.overrun, budget.clocks > 0 && given.clocks > budget.clocks);
            if (slot >= parts[1].first_slot) {
                EXPECT_EQ(given.counts.samples, count_due(second, readout_slot(parts[1], slot), 0,
                                                          shape.rows, shape.cols));
            }
        }
        ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed;
    }
    EXPECT_GT(stretched, 100) << "the test means something";
}

// The rows before the first one that would be late are read, each in time.
TEST(ReadoutCostTest, RowsAreDroppedFromTheFirstLateOneOn) {
    int with_drops = 0, delayed = 0;
    for (std::uint32_t seed = 0; seed < 1000; ++seed) {
        Draw draw(seed);
        ReadoutTiming timing = random_timing(draw);
        timing.overhead_rows = 0;
        const FrameShape shape{draw(1, timing.rows), timing.cols, draw(1, 3)};
        const ExposureSchedule schedule = random_frames(draw);
        const SlotBudget budget{timing.overhead_clocks + timing.code_load_clocks + draw(1, 60),
                                OverrunPolicy::kDrop};
        ReadoutCost dropping(timing, schedule, shape, budget);
        RowLoads row_loads(timing, schedule, shape);
        std::int64_t free_from = 0;  ///< the scan
        for (std::int64_t slot = 0; slot < 2 * kSlots; ++slot) {
            const SlotCost given = dropping.add_next();
            EXPECT_EQ(given.begin, slot * budget.clocks);
            EXPECT_EQ(given.clocks, budget.clocks);
            EXPECT_EQ(given.scan_begin, std::max(given.begin, free_from));
            EXPECT_EQ(given.overrun, given.end_row < shape.rows);
            std::vector<RowLoad> loads;
            row_loads.list(slot, loads);
            bool kept = false;
            for (const RowTimes& row :
                 read_slot_by_ticks(timing, shape.cols, loads, given.scan_begin).rows) {
                if (row.load.row < 0) continue;
                const bool in_time =
                    row.frame_end <=
                    (slot + row_loads.due_again_slots(slot, row.load.row)) * budget.clocks;
                EXPECT_TRUE(in_time || row.load.row >= given.end_row);
                EXPECT_TRUE(!in_time || row.load.row != given.end_row);
                if (row.load.row >= given.end_row) continue;
                free_from = row.frame_end;
                kept = true;
            }
            const auto planes = static_cast<std::uint64_t>(shape.planes);
            EXPECT_EQ(given.counts.samples,
                      planes * count_due(schedule, slot, 0, given.end_row, shape.cols));
            EXPECT_EQ(given.counts.samples + given.counts.dropped_samples,
                      planes * count_due(schedule, slot, 0, shape.rows, shape.cols));
            EXPECT_EQ(given.counts.rows > 0, kept);
            with_drops += given.overrun ? 1 : 0;
            delayed += given.scan_begin > given.begin ? 1 : 0;
        }
        ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed;
    }
    EXPECT_GT(with_drops, 1000) << "the test means something";
    EXPECT_GT(delayed, 1000) << "the test means something";
}

TEST(ReadoutCostTest, APieceThatBeginsLateHasTheSlotsOfTheWhole) {
    for (std::uint32_t seed = 0; seed < kSensors; ++seed) {
        Draw draw(seed);
        const ReadoutTiming timing = random_timing(draw);
        const FrameShape shape{timing.rows, timing.cols, 1};
        const ExposureSchedule schedule = random_frames(draw);
        const SlotBudget budget{timing.overhead_clocks + 200 + draw(1, 60),
                                draw(0, 1) == 0 ? OverrunPolicy::kDrop : OverrunPolicy::kStretch};
        ReadoutCost whole(timing, schedule, shape, budget), piece(timing, schedule, shape, budget);
        for (int slot = 0; slot < kSlots; ++slot) whole.add_next();
        piece.begin_at(kSlots);
        const std::int64_t begin = whole.clocks();
        for (int slot = 0; slot < kSlots; ++slot) {
            const SlotCost expected = whole.add_next();
            const SlotCost given = piece.add_next();
            EXPECT_EQ(given.begin + begin, expected.begin);
            EXPECT_EQ(given.clocks, expected.clocks);
            EXPECT_EQ(given.end_row, expected.end_row);
            EXPECT_EQ(given.overrun, expected.overrun);
        }
        ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed;
    }
}

// 750 frames/s of a chip that has 1069.6: frames of 4 slots need not be read within one.
TEST(ReadoutCostTest, AFrameMayBeReadUntilTheNextOne) {
    const auto timing = sensor_timing("lux1310");
    const SlotBudget budget{slot_clocks(timing, 333.333), OverrunPolicy::kDrop};
    for (const int open_slots : {1, 4}) {
        const ExposureSchedule frames = full_schedule(open_slots, 4);
        ReadoutCost cost(timing, frames, {1024, 1280, 1}, budget);
        for (int slot = 0; slot < 40; ++slot) cost.add_next();
        EXPECT_EQ(cost.overruns(), 0);
        EXPECT_EQ(cost.totals().dropped_samples, 0);
        EXPECT_EQ(cost.totals().samples, 10U * 1024 * 1280);
    }
}

TEST(ReadoutCostTest, AChipThatCannotExposeWhileItReadsNeedsClosedSlots) {
    auto timing = sensor_timing("lux1310");
    timing.exposes_while_reading = false;
    const SlotBudget budget{slot_clocks(timing, 333.333), OverrunPolicy::kDrop};
    // A third of a millisecond of exposure and 0.935 ms of readout are shorter than four slots.
    const ExposureSchedule short_frames = full_schedule(1, 4);
    ReadoutCost cost(timing, short_frames, {1024, 1280, 1}, budget);
    for (int slot = 0; slot < 40; ++slot) cost.add_next();
    EXPECT_EQ(cost.totals().dropped_samples, 0);
    const ExposureSchedule gapless = full_schedule(4, 4);
    expect_parts(message_of<InputError>([&] {
                     ReadoutCost(timing, gapless, {1024, 1280, 1}, budget);
                     return 0;
                 }),
                 {"cannot expose while it reads", "stretch"});
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
        EXPECT_EQ(cost.add_next().clocks, clocks) << "rounded up";
    }
}

TEST(ReadoutCostTest, ASlotLastsAtLeastAsLongAsTheLoadOfItsCode) {
    const auto timing = sensor_timing("lux1310", {"timing.code_load_clocks=100000"});
    const auto every_slot = full_schedule(1, 1);
    ReadoutCost cost(timing, every_slot, {1024, 1280, 1}, {});
    const SlotCost& slot = cost.add_next();
    EXPECT_EQ(slot.clocks, 100000);
    EXPECT_EQ(slot.limit, ReadoutLimit::kCodeLoad);
}

TEST(ReadoutCostTest, ASlotShorterThanTheLoadOfItsCodeIsAnOverrun) {
    // Its readout takes 84143 clocks.
    const auto timing = sensor_timing("lux1310", {"timing.code_load_clocks=100000"});
    const auto every_slot = full_schedule(1, 1);
    for (const auto& [budget, overrun] : {std::pair{99999, true}, std::pair{100000, false}}) {
        ReadoutCost cost(timing, every_slot, {1024, 1280, 1}, {budget, OverrunPolicy::kStretch});
        EXPECT_EQ(cost.add_next().overrun, overrun) << budget;
        EXPECT_EQ(cost.overruns(), overrun ? 1 : 0) << budget;
    }
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

// In whole numbers: n clocks of h Hz take 10^9 n / h ns.
TEST(ReadoutCostTest, ASlotHasTheWholeClocksThatFitInIt) {
    for (std::uint32_t seed = 0; seed < 1000; ++seed) {
        Draw draw(seed);
        ReadoutTiming timing;
        timing.clock_hz = draw(1'000'000, 400'000'000);
        const std::int64_t slot_ns = draw(1000, 20'000'000);
        const std::int64_t clocks = slot_clocks(timing, static_cast<double>(slot_ns) / 1000);
        EXPECT_LE(clocks * 1'000'000'000, slot_ns * timing.clock_hz) << "seed " << seed;
        EXPECT_GT((clocks + 1) * 1'000'000'000, slot_ns * timing.clock_hz) << "seed " << seed;
    }
    ReadoutTiming slow;
    slow.clock_hz = 1'000'000;
    EXPECT_EQ(slot_clocks(slow, 1), 1);
    EXPECT_EQ(slot_clocks(slow, 1.6), 1);
    EXPECT_THROW(static_cast<void>(slot_clocks(slow, 0.6)), InputError);
}

TEST(ReadoutCostTest, ScheduleMemoryIsThatOfTheCompiledProgram) {
    const auto tiled = tiled_schedule(4, 6, std::vector{1, 2, 4, 8}, 1);
    for (const ExposureSchedule& schedule : {tiled, full_schedule(1, 4), full_schedule(4, 4)})
        EXPECT_EQ(schedule_memory_bits(schedule), compile_schedule(schedule).bits());
    EXPECT_EQ(schedule_memory_bits(tiled), 4U * 6 * 15);
}

}  // namespace
}  // namespace stipple
