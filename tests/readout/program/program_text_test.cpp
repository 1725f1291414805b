#include "readout/program/program_text.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/readout/gapped_schedule.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

NamedProgram tiled_program(int tile_rows, int tile_cols) {
    return {"tiled",
            compile_schedule(tiled_schedule(tile_rows, tile_cols, kPaperExposureSlots, 1))};
}

/// `text` with the first `from` replaced.
std::string with(std::string text, std::string_view from, std::string_view to) {
    return text.replace(text.find(from), from.size(), to);
}

std::string fault_of(const std::string& text) {
    return message_of<InputError>([&] { return parse_program(text, "chip.mem"); });
}

TEST(ProgramTextTest, WritesTheLowestColumnIntoTheLowestBits) {
    const ExposureSchedule schedule(1, 3, 2, {0, 1, 2, 3}, {{0, 0b01}, {0, 0b11}, {1, 0b01}});
    const std::string text = program_text({"three", compile_schedule(schedule)});
    // Slot 0: pixel 0 open and read (3), pixel 1 open (2), pixel 2 closed (0): 0b00'10'11 = 0b.
    // Slot 1: closed (0), open and read (3), open and read (3): 0b11'11'00 = 3c.
    expect_parts(text, {"// name = three\n", "// tile_cols = 3\n", "// period_slots = 2\n",
                        "// bits_per_pixel = 2\n", "// 12 bits;", "@0  // slot 0\n0b\n",
                        "@1  // slot 1\n3c\n"});
}

TEST(ProgramTextTest, ComesBackFromItsText) {
    for (const int cols : {1, 3, 4, 15, 33}) {
        const NamedProgram program = tiled_program(3, cols);
        const NamedProgram again = parse_program(program_text(program), "chip.mem");
        EXPECT_EQ(again.program, program.program) << cols;
        EXPECT_EQ(again.name, "tiled");
    }
    const NamedProgram gapped = {"gaps", compile_schedule(gapped_schedule(4, 7, 33, 5))};
    EXPECT_EQ(parse_program(program_text(gapped), "chip.mem").program, gapped.program);
}

TEST(ProgramTextTest, TakesWordsInAnyOrderAndLayoutThatReadmememhTakes) {
    const NamedProgram program = {"full", compile_schedule(full_schedule(2, 4))};
    const std::string head = program_text(program).substr(0, program_text(program).find('@'));
    EXPECT_EQ(parse_program(head + "@2 0 0\n\t@0 2 3 // slots 0 and 1\r\n", "x").program,
              program.program);
}

TEST(ProgramTextTest, NamesFileLineAndProblem) {
    const std::string good = program_text(tiled_program(2, 6));
    const std::string first_word = good.substr(good.find("slot 0\n") + 7, 2);
    expect_parts(fault_of(""), {"chip.mem", "no word"});
    expect_parts(fault_of("00\n"), {"chip.mem:1", "stipple sequencer program"});
    expect_parts(fault_of(with(good, "// tile_cols = 6\n", "")), {"tile_cols"});
    expect_parts(fault_of(with(good, "tile_cols = 6", "tile_cols = 0")),
                 {"chip.mem:4", "tile_cols = 0", "1 to 65535"});
    expect_parts(fault_of(with(good, "tile_cols = 6", "tile_cols = 9")), {"2 digits", "take 3"});
    expect_parts(fault_of(with(good, "period_slots = 15", "period_slots = 60000")), {"too short"});
    expect_parts(fault_of(with(good, "period_slots = 15", "period_slots = 16")),
                 {"slot 15, tile row 0 (address 1e) is missing"});
    expect_parts(fault_of(with(good, "period_slots = 15", "period_slots = 14")),
                 {"address 1c is beyond the last word, 1b"});
    expect_parts(fault_of(with(good, "@2", "@1")), {"address 1 comes twice"});
    expect_parts(fault_of(with(good, "@2", "@zz")), {"zz", "address"});
    expect_parts(fault_of(with(good, "slot 0\n" + first_word, "slot 0\nxx")), {"\"x\""});
    expect_parts(fault_of(with(good, "slot 0\n" + first_word, "slot 0\nff")),
                 {"chip.mem:9", "beyond its last column"});
}

}  // namespace
}  // namespace stipple
