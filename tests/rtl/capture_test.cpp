#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/index.h"
#include "core/schedule_parts.h"
#include "readout/chip_registers.h"
#include "stream/stream_writer.h"
#include "tests/rtl/chip_capture.h"
#include "tests/rtl/expected_run.h"
#include "tests/rtl/random_chip.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

/// A DN that tells scan, row and column apart.
std::uint16_t dn_of(int scan, int row, int col, int bit_depth) {
    const unsigned mixed = static_cast<unsigned>(scan) * 7919U +
                           static_cast<unsigned>(row) * 104729U +
                           static_cast<unsigned>(col) * 1299709U;
    return static_cast<std::uint16_t>((mixed ^ mixed >> 7U) & ((1U << bit_depth) - 1U));
}

ColumnDn numbered_dn(const ChipParameters& size) {
    return [size](int scan, int row) {
        std::vector<std::uint16_t> columns;
        for (int col = 0; col < size.cols; ++col)
            columns.push_back(dn_of(scan, row, col, size.bit_depth));
        return columns;
    };
}

/// The first slot that begins after the tables of the other bank are filled and the swap is taken.
std::int64_t slot_after_swap(const ChipSimulation& chip, std::int64_t filled) {
    const auto& starts = chip.events.slot_start;
    const auto begins = [&](std::int64_t clock) {
        return std::ranges::binary_search(starts, ChipEvent{clock - chip.first_slot, 0});
    };
    std::int64_t taken = filled;
    while (begins(taken)) ++taken;
    return std::ranges::upper_bound(starts, ChipEvent{taken - chip.first_slot, 0}) - starts.begin();
}

/// A capture with a swap.
struct SwapRun {
    const ChipModel& model;
    ExposureSchedule first, second;
    ChipCapture capture;
    int second_offset = 0;

    [[nodiscard]] StreamHeader header() const {
        return {.shape = capture.window,
                .calibration = {.bit_depth = model.size.bit_depth},
                .schedule = first,
                .schedule_source = {},
                .schedule_name = "",
                .provenance = "",
                .may_switch = true};
    }
    [[nodiscard]] std::uint32_t header_crc() const {
        const TemporaryFolder folder;
        StreamWriter(folder / "a.stipple", header()).finish();
        return read_stream_bytes(folder / "a.stipple").header_crc;
    }
    /// The packets that a writer of the stream makes of the same samples, if the swap is before
    /// `slot`. The lengths of slots are the chip's.
    [[nodiscard]] std::vector<std::uint8_t> expected(const ChipSimulation& chip, std::int64_t slot,
                                                     std::uint32_t overruns) const;
};

/// Packets of kind 4 are the host's.
std::vector<std::uint8_t> without_switches(std::vector<std::uint8_t> bytes) {
    const auto field = [&](std::size_t at) {
        return bytes[at] | bytes[at + 1] << 8U | bytes[at + 2] << 16U | bytes[at + 3] << 24U;
    };
    std::vector<std::uint8_t> kept;
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t end = at + 36 + static_cast<std::size_t>(field(at + 24));
        if (bytes[at + 4] == 1)
            kept.insert(kept.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                        bytes.begin() + static_cast<std::ptrdiff_t>(end));
        at = end;
    }
    return kept;
}

std::vector<std::uint8_t> SwapRun::expected(const ChipSimulation& chip, std::int64_t slot,
                                            std::uint32_t overruns) const {
    const TemporaryFolder folder;
    const auto file = folder / "a.stipple";
    const int period = second.period_slots();
    const ExposureSchedule after = schedule_of(
        program_for(second, model.size,
                    static_cast<int>((slot - second_offset % period + period) % period)),
        "test");
    StreamWriter writer(file, header());
    const std::vector<SchedulePart> parts{{&first, 0}, {&after, slot}};
    for (int t = 0, scan = -1; t < capture.slots; ++t) {
        if (t == slot) {
            writer.switch_schedule(
                {.slot = t, .schedule = after, .source = {}, .name = "", .values = {}});
        }
        const SchedulePart& part = parts[t < slot ? 0 : 1];
        SamplePacket packet{t, 0, capture.window.rows, 0, {}};
        const std::int64_t at = readout_slot(part, t);
        if (count_due(*part.schedule, at, 0, capture.window.rows, capture.window.cols) > 0) ++scan;
        for (int row = 0; row < capture.window.rows; ++row)
            for_each_readout(*part.schedule, at, row, capture.window.cols, [&](int col, int) {
                packet.dn.push_back(dn_of(scan, row, col, model.size.bit_depth));
            });
        const auto& starts = chip.events.slot_start;
        const bool is_overrun =
            t + 1 == capture.slots
                ? overruns > 0  // what is left for the last one
                : capture.budget.clocks > 0 &&
                      starts[index(t) + 1].clock - starts[index(t)].clock > capture.budget.clocks;
        packet.flags = is_overrun ? SamplePacket::kOverrun : std::uint8_t{0};
        overruns -= is_overrun ? 1 : 0;
        writer.write(packet);
    }
    writer.finish();
    return without_switches(read_stream_bytes(file).packets);
}

/// A run whose stream a writer takes: no interleaved exposures.
SwapRun random_swap(std::uint32_t seed, Draw& draw) {
    const ChipModel& chip = chip_models()[seed % chip_models().size()];
    const auto draw_schedule = [&](std::uint32_t of) {
        ExposureSchedule schedule = schedule_for(chip.size, of, draw);
        while (schedule.interleaved()) schedule = schedule_for(chip.size, of, draw);
        return schedule;
    };
    SwapRun run{chip, draw_schedule(seed), draw_schedule(seed + 1000), {}};
    const int rows = draw(1, chip.size.rows);
    run.capture = {
        .timing = random_chip_timing(chip.size, draw),
        .window = FrameShape{rows, draw(1, chip.size.cols), 1},
        .budget = SlotBudget{draw(0, 2) == 0 ? 0 : draw(1, 200), OverrunPolicy::kStretch},
        .period_slots = compile_schedule(run.first).period_slots,
        .slots = draw(20, 60)};
    run.second_offset = draw(0, compile_schedule(run.second).period_slots - 1);
    return run;
}

TEST(CaptureTest, ASwapLosesNoSampleAndTearsNoSlot) {
    int swaps = 0, late = 0;
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        Draw draw(seed);
        const SwapRun run = random_swap(seed, draw);
        const auto chip = run.model.make(run.model.size,
                                         {"", run.header_crc(), numbered_dn(run.model.size), seed});
        load_bank(*chip, program_for(run.first, run.model.size), 0);
        load_bank(*chip, program_for(run.second, run.model.size), 1);
        set(*chip, STIPPLE_BANK_OFFSET + 4, static_cast<std::uint32_t>(run.second_offset));
        set_up(*chip, run.capture);
        set(*chip, STIPPLE_CONTROL, STIPPLE_CONTROL_START);
        while (get(*chip, STIPPLE_SLOT_COUNT) < static_cast<std::uint32_t>(draw(1, 5))) {
        }
        const std::int64_t swap = chip->clocks;
        set(*chip, STIPPLE_CONTROL, STIPPLE_CONTROL_SWAP);
        wait_for_end(*chip, 1'000'000);
        EXPECT_EQ(get(*chip, STIPPLE_ERROR), 0U);
        if ((get(*chip, STIPPLE_STATUS) & STIPPLE_STATUS_BANK) == 0) {  // it ended before
            ++late;
            continue;
        }
        ++swaps;
        const std::int64_t slot = get(*chip, STIPPLE_SWAP_SLOT);
        EXPECT_EQ(slot,
                  slot_after_swap(*chip, swap + 1 +
                                             fill_clocks(run.model.size, run.capture.window.rows,
                                                         run.second.period_slots())));
        const std::int64_t begin = chip->events.slot_start[index(slot)].clock;
        const auto before = [begin](const ChipEvent& it) { return it.clock < begin; };
        const auto until = [begin](const ChipEvent& it) { return it.clock <= begin; };
        EXPECT_EQ(std::ranges::count_if(chip->events.select, before),
                  std::ranges::count_if(chip->events.row_done, until));
        EXPECT_EQ(chip->bytes, run.expected(*chip, slot, get(*chip, STIPPLE_OVERRUN_COUNT)));
        if (HasFailure()) return;
    }
    EXPECT_GT(swaps, 50);
}

/// A chip that is set up for captures of tiled frames, slot by slot.
std::unique_ptr<ChipSimulation> set_up_chip(const ExposureSchedule& schedule, int slots) {
    const ChipModel& paper = model("paper");
    auto chip = paper.make(paper.size, {"", 0, numbered_dn(paper.size), 1});
    load_bank(*chip, program_for(schedule, paper.size), 0);
    Draw draw(3);
    set_up(*chip, {.timing = random_chip_timing(paper.size, draw),
                   .window = FrameShape{16, 24, 1},
                   .budget = SlotBudget{100, OverrunPolicy::kStretch},
                   .period_slots = schedule.period_slots(),
                   .slots = slots});
    return chip;
}

TEST(CaptureTest, StopsBetweenTwoSlotsAndBeginsAnewWithTheSameBytes) {
    const ExposureSchedule schedule = random_schedule(16, 16, std::vector{1, 2, 4}, 1);
    const auto chip = set_up_chip(schedule, 0);
    set(*chip, STIPPLE_CONTROL, STIPPLE_CONTROL_START);
    while (get(*chip, STIPPLE_SLOT_COUNT) < 5) {
    }
    EXPECT_EQ(get(*chip, STIPPLE_STATUS), STIPPLE_STATUS_RUNNING | STIPPLE_STATUS_EXPOSING);
    set(*chip, STIPPLE_CONTROL, STIPPLE_CONTROL_STOP);
    wait_for_end(*chip, 100'000);
    EXPECT_EQ(get(*chip, STIPPLE_SLOT_COUNT), 5U);
    EXPECT_EQ(chip->packets, 5);
    const std::vector<std::uint8_t> bytes = chip->bytes;

    const auto again = set_up_chip(schedule, 5);
    for (int capture = 0; capture < 2; ++capture) {
        again->bytes.clear();
        again->events = {};
        again->packets = 0;
        set(*again, STIPPLE_CONTROL, STIPPLE_CONTROL_START);
        wait_for_end(*again, 100'000);
        EXPECT_EQ(again->bytes, bytes);
        EXPECT_EQ(get(*again, STIPPLE_PACKET_COUNT), 5U);
    }
}

TEST(CaptureTest, AStopBeforeSlot0LeavesNoPacket) {
    const auto chip = set_up_chip(random_schedule(16, 16, std::vector{1, 2, 4}, 1), 0);
    set(*chip, STIPPLE_CONTROL, STIPPLE_CONTROL_START);
    set(*chip, STIPPLE_CONTROL, STIPPLE_CONTROL_STOP);
    wait_for_end(*chip, 100'000);
    EXPECT_EQ(get(*chip, STIPPLE_SLOT_COUNT), 0U);
    EXPECT_EQ(chip->packets, 0);
}

/// A register of the table (readout/chip_registers.h).
struct TableRegister {
    const char* name;
    std::uint32_t address, count, bits, reset;
    std::string access, lock;
};
#define STIPPLE_ROW(name, address, count, bits, reset, access, lock) \
    {#name, address, count, bits, reset, #access, #lock},
const TableRegister kRegisters[] = {STIPPLE_REGISTERS(STIPPLE_ROW)};
#undef STIPPLE_ROW

TEST(CaptureTest, RegistersTakeWhatTheTableSays) {
    const ChipModel& paper = model("paper");
    const auto chip = paper.make(paper.size, {"", 0, numbered_dn(paper.size), 1});
    std::vector<bool> is_there(4096);
    for (const TableRegister& it : kRegisters)
        for (std::uint32_t at = it.address; at < it.address + 4 * it.count; at += 4) {
            SCOPED_TRACE(it.name);
            is_there[at] = true;
            const std::uint32_t most = it.bits == 32 ? ~0U : (1U << it.bits) - 1U;
            if (it.access == "both") {
                EXPECT_EQ(chip->read(at), it.reset);
            }
            EXPECT_EQ(chip->read(at).has_value(), true);
            if (it.access == "read") {
                EXPECT_FALSE(chip->write(at, 0));
            }
            if (it.bits < 32) {
                EXPECT_FALSE(chip->write(at, most + 1));
            }
            if (it.access != "both") continue;
            for (const std::uint32_t value : {most, 0x5A5A5A5AU & most, it.reset}) {
                EXPECT_TRUE(chip->write(at, value));
                EXPECT_EQ(chip->read(at), value);
            }
        }
    EXPECT_EQ(get(*chip, STIPPLE_ID), 0x53504C31U);
    EXPECT_EQ(get(*chip, STIPPLE_ARRAY_ROWS), 16U);
    EXPECT_EQ(get(*chip, STIPPLE_ARRAY_COLS), 24U);
    EXPECT_EQ(get(*chip, STIPPLE_CHANNELS), 4U);
    EXPECT_EQ(get(*chip, STIPPLE_BIT_DEPTH), 10U);
    EXPECT_EQ(get(*chip, STIPPLE_ERROR), STIPPLE_ERROR_ACCESS + 0U);
    set(*chip, STIPPLE_ERROR, STIPPLE_ERROR_ACCESS);
    EXPECT_EQ(get(*chip, STIPPLE_ERROR), 0U);
    for (std::uint32_t at = 0; at < 4096; ++at) {
        if (is_there[at]) continue;
        EXPECT_FALSE(chip->read(at).has_value()) << at;
        EXPECT_FALSE(chip->write(at, 0)) << at;
    }
}

TEST(CaptureTest, RefusesSettingsBeyondItsLimits) {
    struct Bad {
        std::uint32_t address, value;
    };
    for (const Bad& bad :
         {Bad{STIPPLE_ROWS, 0}, Bad{STIPPLE_ROWS, 17}, Bad{STIPPLE_COLS, 0}, Bad{STIPPLE_COLS, 25},
          Bad{STIPPLE_SLOT_CLOCKS, 0}, Bad{STIPPLE_CLOCKS_PER_COLUMN, 0},
          Bad{STIPPLE_ROW_TIMING, 3}, Bad{STIPPLE_DARK_ROWS, 2}, Bad{STIPPLE_BANK_PERIOD, 0},
          Bad{STIPPLE_BANK_PERIOD, 17}, Bad{STIPPLE_BANK_OFFSET, 7}}) {
        SCOPED_TRACE(fmt::format("0x{:03X} = {}", bad.address, bad.value));
        const auto chip = set_up_chip(random_schedule(16, 16, std::vector{1, 2, 4}, 1), 1);
        set(*chip, bad.address, bad.value);
        set(*chip, STIPPLE_CONTROL, STIPPLE_CONTROL_START);
        EXPECT_EQ(get(*chip, STIPPLE_STATUS), 0U);
        EXPECT_EQ(get(*chip, STIPPLE_ERROR), STIPPLE_ERROR_SETUP + 0U);
    }
    const auto chip = set_up_chip(random_schedule(16, 16, std::vector{1, 2, 4}, 1), 0);
    set(*chip, STIPPLE_MEMORY_ADDRESS, 16 * 16);
    EXPECT_FALSE(chip->write(STIPPLE_MEMORY_DATA, 0));
    set(*chip, STIPPLE_ERROR, ~0U >> 25U);
    set(*chip, STIPPLE_CONTROL, STIPPLE_CONTROL_START);
    set(*chip, STIPPLE_CONTROL, STIPPLE_CONTROL_SWAP);  // to a bank without a program
    EXPECT_EQ(get(*chip, STIPPLE_ERROR), STIPPLE_ERROR_SETUP + 0U);
    for (const TableRegister& it : kRegisters) {
        if (it.access != "both") continue;
        const std::uint32_t value = get(*chip, it.address);
        EXPECT_EQ(chip->write(it.address, value), it.lock == "none") << it.name;
        EXPECT_EQ(chip->write(it.address + 4, 0), it.lock == "bank") << it.name;
    }
}

}  // namespace
}  // namespace stipple
