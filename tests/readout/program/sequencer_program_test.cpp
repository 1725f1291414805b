#include "readout/program/sequencer_program.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/readout/gapped_schedule.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr unsigned kRead = SequencerProgram::kRead;
constexpr unsigned kOpen = SequencerProgram::kOpen;

/// Bits of a pixel of a tile of one pixel, slot by slot.
std::vector<std::uint8_t> pixels_of(const ExposureSchedule& schedule) {
    return compile_schedule(schedule).pixels;
}

/// Expects a program that says for each pixel and slot what `for_each_readout` and the masks say.
void expect_as_defined(const ExposureSchedule& schedule) {
    const SequencerProgram program = compile_schedule(schedule);
    std::size_t word = 0;
    for (int slot = 0; slot < schedule.period_slots(); ++slot)
        for (int row = 0; row < schedule.tile_rows(); ++row, ++word) {
            std::vector<std::uint8_t> expected(static_cast<std::size_t>(schedule.tile_cols()));
            for (int col = 0; col < schedule.tile_cols(); ++col)
                for (const Exposure& e : schedule.exposures(row, col)) {
                    const auto period = static_cast<std::uint32_t>(schedule.period_slots());
                    const auto age =
                        (static_cast<std::uint32_t>(slot) + period - e.first_slot) % period;
                    if (age < 64 && (e.open_slots >> age & 1U) != 0 && program.bits_per_pixel == 2)
                        expected[static_cast<std::size_t>(col)] |= kOpen;
                }
            for_each_readout(schedule, slot + std::int64_t{schedule.period_slots()} * 64, row,
                             schedule.tile_cols(), [&](int col, int) {
                                 expected[static_cast<std::size_t>(col)] |= kRead;
                             });
            for (std::size_t col = 0; col < expected.size(); ++col)
                ASSERT_EQ(program.pixels[word * expected.size() + col], expected[col])
                    << "slot " << slot << " pixel " << row << ", " << col;
        }
}

TEST(SequencerProgramTest, SaysWhatTheScheduleSays) {
    expect_as_defined(tiled_schedule(5, 9, kPaperExposureSlots, 1));
    expect_as_defined(full_schedule(1, 4));
    expect_as_defined(gapped_schedule(6, 7, 40, 3));
}

TEST(SequencerProgramTest, NeedsOneBitPerPixelAndSlotWithoutGapsAndTwoWith) {
    const SequencerProgram tiled = compile_schedule(tiled_schedule(4, 6, kPaperExposureSlots, 1));
    EXPECT_EQ(tiled.bits(), 4U * 6U * 15U);
    EXPECT_EQ(compile_schedule(full_schedule(1, 4)).bits(), 2U * 4U);
}

TEST(SequencerProgramTest, GivesTheScheduleBack) {
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        const ExposureSchedule gapped = gapped_schedule(5, 8, 37, seed);
        EXPECT_EQ(schedule_of(compile_schedule(gapped), "test"), gapped) << "seed " << seed;
        const ExposureSchedule tiled = tiled_schedule(6, 5, kPaperExposureSlots, seed);
        EXPECT_EQ(schedule_of(compile_schedule(tiled), "test"), tiled) << "seed " << seed;
    }
    for (const int period : {1, 4, 64}) {
        const ExposureSchedule full = full_schedule(period, period);
        EXPECT_EQ(schedule_of(compile_schedule(full), "test"), full) << "period " << period;
    }
}

TEST(SequencerProgramTest, ReadsAnExposureAcrossTheEndOfThePeriod) {
    const ExposureSchedule schedule(1, 1, 6, {0, 1}, {{4, 0b101}});
    EXPECT_EQ(pixels_of(schedule), (std::vector<std::uint8_t>{kOpen | kRead, 0, 0, 0, kOpen, 0}));
    EXPECT_EQ(schedule_of(compile_schedule(schedule), "test"), schedule);
}

TEST(SequencerProgramTest, KeepsTwoStoresApart) {
    // Slots 0, 2, 4 into one store, 1, 3 into the other; read in slots 4 and 3.
    const ExposureSchedule two_bucket(1, 1, 5, {0, 2}, {{0, 0b10101}, {1, 0b101}});
    constexpr unsigned kStore = SequencerProgram::kStore;
    EXPECT_EQ(pixels_of(two_bucket),
              (std::vector<std::uint8_t>{kOpen, kOpen | kStore, kOpen, kOpen | kStore | kRead,
                                         kOpen | kRead}));
    EXPECT_EQ(schedule_of(compile_schedule(two_bucket), "test"), two_bucket);
}

TEST(SequencerProgramTest, CoversTwoPeriodsWhereAnExposureChangesStores) {
    // Three exposures of 4 slots in a period of 6, each begun before the last one has ended.
    const ExposureSchedule odd(1, 1, 6, {0, 3}, {{0, 0b1001}, {2, 0b1001}, {4, 0b1001}});
    ASSERT_TRUE(odd.interleaved());
    const SequencerProgram program = compile_schedule(odd);
    EXPECT_EQ(program.period_slots, 12);
    const ExposureSchedule twice = schedule_of(program, "test");
    for (int slot = 0; slot < 24; ++slot)
        for_each_readout(odd, slot, 0, 1, [&](int, int span_slots) {
            int found = 0;
            for_each_readout(twice, slot, 0, 1, [&](int, int span) { found = span; });
            EXPECT_EQ(found, span_slots) << "slot " << slot;
        });
}

TEST(SequencerProgramTest, NamesPixelAndSlotOfWhatCannotBe) {
    SequencerProgram program{.tile_rows = 1,
                             .tile_cols = 2,
                             .period_slots = 3,
                             .bits_per_pixel = 2,
                             .pixels = {0, kOpen, 0, kOpen | kRead, 0, 0}};
    EXPECT_EQ(schedule_of(program, "chip.mem").exposures(0, 1).size(), 1U);
    program.pixels[4] = kRead;
    expect_parts(message_of<InputError>([&] { return schedule_of(program, "chip.mem"); }),
                 {"chip.mem", "pixel (0, 0) slot 2", "closed"});
    program.pixels[4] = kOpen;
    expect_parts(message_of<InputError>([&] { return schedule_of(program, "chip.mem"); }),
                 {"chip.mem", "pixel (0, 0) slot 2", "never read"});
    program = {.tile_rows = 1,
               .tile_cols = 1,
               .period_slots = 65,
               .bits_per_pixel = 1,
               .pixels = std::vector<std::uint8_t>(65)};
    program.pixels[30] = kRead;
    expect_parts(message_of<InputError>([&] { return schedule_of(program, "chip.mem"); }),
                 {"pixel (0, 0) slot 31", "64 slots"});
}

}  // namespace
}  // namespace stipple
