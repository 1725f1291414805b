#include "readout/chip/register_chip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "readout/chip/register_map.h"
#include "readout/chip_registers.h"
#include "readout/program/sequencer_program.h"
#include "tests/readout/chip/small_chip.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

class RegisterChipTest : public SmallChipTest {};

/// Waits until the state that clock `clock` sees is read next.
void wait_until(RegisterChip& chip, std::int64_t clock) {
    ASSERT_LE(chip.clocks(), clock);
    chip.wait(clock - chip.clocks());
}

TEST_F(RegisterChipTest, ASingleShotIsExactToTheClock) {
    const SensorSetup setup = small_sensor("tiled");
    RegisterChip chip = preset_chip(setup);
    set(chip, STIPPLE_SLOTS, 1);
    const std::int64_t start = chip.clocks();
    set(chip, STIPPLE_CONTROL, kStart);
    EXPECT_EQ(get(chip, STIPPLE_STATUS), std::uint32_t{STIPPLE_STATUS_RUNNING});
    const int period = setup.schedule.schedule.period_slots();
    const std::int64_t fill = (3 * setup.schedule.schedule.tile_rows() + 2 * 8) * period;
    const std::int64_t slot_0 = start + 2 + fill;
    wait_until(chip, slot_0 - 1);
    EXPECT_EQ(get(chip, STIPPLE_SLOT_COUNT), 0U);
    // In the clock after the one in which slot 0 begins.
    EXPECT_EQ(get(chip, STIPPLE_SLOT_COUNT), 1U);
    constexpr std::uint32_t kBoth = STIPPLE_STATUS_RUNNING | STIPPLE_STATUS_EXPOSING;
    wait_until(chip, slot_0 + 39);
    EXPECT_EQ(get(chip, STIPPLE_STATUS), kBoth);
    wait_until(chip, slot_0 + 41);
    EXPECT_EQ(get(chip, STIPPLE_STATUS) & STIPPLE_STATUS_EXPOSING, 0U);
    chip.wait(1000);
    EXPECT_EQ(get(chip, STIPPLE_STATUS), 0U);
    EXPECT_EQ(get(chip, STIPPLE_SLOT_COUNT), 1U);
    EXPECT_EQ(get(chip, STIPPLE_PACKET_COUNT), 1U);
    const Recorded expected = emulated(setup, 1), given = read_stream(folder_ / "a.stipple");
    EXPECT_EQ(given.packets, expected.packets);
    EXPECT_FALSE(given.may_switch);
    EXPECT_EQ(get(chip, STIPPLE_SAMPLE_COUNT), expected.packets[0].dn.size());
}

// With slots that are stretched: the samples, flags and times are those of the emulator.
TEST_F(RegisterChipTest, ACaptureIsThatOfTheEmulator) {
    SensorSetup setup = small_sensor("tiled");
    RegisterChip chip = preset_chip(setup);
    const std::int64_t start = chip.clocks();
    set(chip, STIPPLE_CONTROL, kStart);
    const ExposureSchedule& schedule = setup.schedule.schedule;
    const std::int64_t slot_0 =
        start + 2 + (3 * schedule.tile_rows() + 16) * schedule.period_slots();
    ReadoutCost cost(*setup.timing, schedule, kArray, {40, OverrunPolicy::kStretch});
    std::int64_t last_begin = 0;
    for (int slot = 0; slot < 20; ++slot) last_begin = cost.add_next().begin;
    EXPECT_GT(cost.overruns(), 5);
    wait_until(chip, slot_0 + last_begin - 1);
    EXPECT_EQ(get(chip, STIPPLE_SLOT_COUNT), 19U);
    EXPECT_EQ(get(chip, STIPPLE_SLOT_COUNT), 20U);
    set(chip, STIPPLE_CONTROL, STIPPLE_CONTROL_STOP);
    chip.wait(10000);
    EXPECT_EQ(get(chip, STIPPLE_STATUS), 0U);
    EXPECT_EQ(get(chip, STIPPLE_OVERRUN_COUNT), static_cast<std::uint32_t>(cost.overruns()));
    EXPECT_EQ(get(chip, STIPPLE_PACKET_COUNT), 20U);
    EXPECT_EQ(get(chip, STIPPLE_SAMPLE_COUNT), cost.totals().samples);
    EXPECT_EQ(read_stream(folder_ / "a.stipple").packets, emulated(setup, 20).packets);
    EXPECT_EQ(get(chip, STIPPLE_ERROR), 0U);
}

TEST_F(RegisterChipTest, DroppedRowsAreThoseOfTheEmulator) {
    SensorSetup setup = small_sensor("tiled");
    setup.overrun = OverrunPolicy::kDrop;
    RegisterChip chip = preset_chip(setup);
    set(chip, STIPPLE_SLOTS, 15);
    set(chip, STIPPLE_CONTROL, kStart);
    set(chip, STIPPLE_CONTROL, STIPPLE_CONTROL_SWAP);
    EXPECT_EQ(get(chip, STIPPLE_ERROR), std::uint32_t{STIPPLE_ERROR_SETUP});
    chip.wait(10000);
    const Recorded expected = emulated(setup, 15);
    EXPECT_EQ(read_stream(folder_ / "a.stipple").packets, expected.packets);
    EXPECT_EQ(get(chip, STIPPLE_DROPPED_COUNT),
              std::ranges::count_if(expected.packets, [](const SamplePacket& packet) {
                  return (packet.flags & SamplePacket::kDropped) != 0;
              }));
    EXPECT_GT(get(chip, STIPPLE_DROPPED_COUNT), 0U);
}

/// Writes a schedule of the chip's tile through the registers.
void load(RegisterChip& chip, const ExposureSchedule& schedule, std::uint32_t bank,
          std::uint32_t offset) {
    const SequencerProgram program = compile_schedule(schedule);
    ASSERT_LE(program.tile_cols * program.bits_per_pixel, 32);
    set(chip, STIPPLE_MEMORY_ADDRESS, bank << 31U);
    const auto cols = static_cast<std::size_t>(program.tile_cols);
    for (std::size_t first = 0; first < program.pixels.size(); first += cols) {
        std::uint32_t word = 0;
        for (std::size_t col = 0; col < cols; ++col)
            word |= std::uint32_t{program.pixels[first + col]}
                    << (col * static_cast<std::size_t>(program.bits_per_pixel));
        set(chip, STIPPLE_MEMORY_DATA, word);
    }
    set(chip, STIPPLE_BANK_PERIOD + 4 * bank, static_cast<std::uint32_t>(program.period_slots));
    set(chip, STIPPLE_BANK_OFFSET + 4 * bank, offset);
}

/// The schedule whose slot p is slot (p + first) mod period of `schedule`.
ExposureSchedule rotated(const ExposureSchedule& schedule, std::int64_t first) {
    SequencerProgram program = compile_schedule(schedule);
    const auto slot = static_cast<std::ptrdiff_t>(program.tile_rows * program.tile_cols);
    std::rotate(program.pixels.begin(),
                program.pixels.begin() + slot * (first % program.period_slots),
                program.pixels.end());
    return schedule_of(program, "rotated");
}

// Random times of the swap: its slot by the definition, slot by slot on a second time line.
TEST_F(RegisterChipTest, ASwapIsExactToTheClock) {
    const SensorSetup setup = small_sensor("tiled");
    const SensorSetup other = small_sensor("tiled", {"exposure_slots=[1,3]"});
    const ExposureSchedule& first = setup.schedule.schedule;
    const ExposureSchedule& second = other.schedule.schedule;
    ASSERT_EQ(first.tile_rows(), second.tile_rows());
    constexpr std::uint32_t kOffset = 2;
    for (const int wait : {0, 1, 100, 400, 401, 402, 403, 700, 1111}) {
        const TemporaryFolder folder;
        RegisterChip chip(setup, geometry_of(setup),
                          {.output = folder / "a.stipple", .open_light = repeated_light()});
        chip.preset();
        load(chip, second, 1, kOffset);
        const std::int64_t start = chip.clocks();
        set(chip, STIPPLE_CONTROL, kStart);
        const std::int64_t slot_0 = start + 2 + (3 * first.tile_rows() + 16) * first.period_slots();
        chip.wait(wait);
        const std::int64_t written = chip.clocks();
        set(chip, STIPPLE_CONTROL, STIPPLE_CONTROL_SWAP);
        EXPECT_NE(get(chip, STIPPLE_STATUS) & STIPPLE_STATUS_SWAP_PENDING, 0U);
        EXPECT_FALSE(chip.write(STIPPLE_BANK_OFFSET + 4, 0));

        const std::int64_t from =
            std::max(written, slot_0) + 1 + (3 * second.tile_rows() + 16) * second.period_slots();
        ReadoutCost cost(*setup.timing, first, kArray, {40, OverrunPolicy::kStretch});
        SlotCost slot;
        do slot = cost.add_next();
        while (std::max(from, slot_0 + slot.begin + 1) >= slot_0 + slot.begin + slot.clocks);
        const std::int64_t swap_slot = cost.slots();
        cost.switch_to(second);
        wait_until(chip, slot_0 + cost.clocks() - 1);
        EXPECT_EQ(get(chip, STIPPLE_SWAP_SLOT), 0U);
        EXPECT_EQ(get(chip, STIPPLE_SWAP_SLOT), swap_slot);
        EXPECT_EQ(
            get(chip, STIPPLE_STATUS),
            std::uint32_t{STIPPLE_STATUS_RUNNING | STIPPLE_STATUS_EXPOSING | STIPPLE_STATUS_BANK});
        chip.wait(500);
        chip.finish();

        const std::uint32_t slots = get(chip, STIPPLE_SLOT_COUNT);
        SensorSetup next = setup;
        const int period = second.period_slots();
        next.schedule.schedule =
            rotated(second, (kOffset + std::int64_t{period} - swap_slot % period) % period);
        const Recorded expected = emulated(setup, static_cast<int>(slots), &next, swap_slot);
        const Recorded given = read_stream(folder / "a.stipple");
        ASSERT_EQ(given.switches.size(), 1U) << wait;
        EXPECT_EQ(given.switches[0].schedule, next.schedule.schedule);
        EXPECT_EQ(given.switches[0].slot, swap_slot);
        EXPECT_EQ(given.packets, expected.packets) << wait;
    }
}

TEST_F(RegisterChipTest, TheOffsetIsTheSlotWithWhichTheProgramBegins) {
    const SensorSetup setup = small_sensor("tiled");
    RegisterChip chip = preset_chip(setup);
    set(chip, STIPPLE_BANK_OFFSET, 3);
    set(chip, STIPPLE_SLOTS, 9);
    set(chip, STIPPLE_CONTROL, kStart);
    chip.wait(10000);
    SensorSetup late = setup;
    late.schedule.schedule = rotated(setup.schedule.schedule, 3);
    EXPECT_EQ(read_stream(folder_ / "a.stipple").packets, emulated(late, 9).packets);
}

TEST_F(RegisterChipTest, ARegionIsAPartOfTheLight) {
    const SensorSetup setup = small_sensor("tiled");
    RegisterChip chip = preset_chip(setup);
    set(chip, STIPPLE_ROWS, 5);
    set(chip, STIPPLE_COLS, 7);
    set(chip, STIPPLE_SLOTS, 3);
    set(chip, STIPPLE_CONTROL, kStart);
    chip.wait(10000);
    SensorSetup region = setup;
    region.shape.rows = region.footage.rows = 5;
    region.shape.cols = region.footage.cols = 7;
    StreamRecorder recorder(folder_ / "b.stipple", region);
    for (int slot = 0; slot < 3; ++slot) {
        const std::vector<float> frame = frame_of(slot, kArray.pixels());
        std::vector<float> part;
        for (std::size_t row = 0; row < 5; ++row)
            part.insert(part.end(), frame.begin() + static_cast<std::ptrdiff_t>(12 * row),
                        frame.begin() + static_cast<std::ptrdiff_t>(12 * row + 7));
        recorder.expose(part);
    }
    recorder.finish();
    EXPECT_EQ(read_stream(folder_ / "a.stipple").packets,
              read_stream(folder_ / "b.stipple").packets);
}

}  // namespace
}  // namespace stipple
