#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/arguments/common_options.h"
#include "apps/arguments/schedule.h"
#include "apps/output/json_file.h"
#include "apps/subcommands.h"
#include "io/output_names.h"
#include "io/text_file.h"
#include "readout/program/program_text.h"

namespace stipple {
namespace {

struct CompileOptions {
    ScheduleChoice schedule;
    std::string output;
};

void compile(const CompileOptions& options, const RunOptions& run) {
    const NamedSchedule schedule = chosen_schedule(options.schedule);
    const NamedProgram named = {schedule.name, compile_schedule(schedule.schedule)};
    JsonFile json(run);
    write_text_file(options.output, run.force, program_text(named));
    const SequencerProgram& program = named.program;
    const auto words = std::int64_t{program.period_slots} * program.tile_rows;
    json.write({{"name", named.name},
                {"tile_rows", program.tile_rows},
                {"tile_cols", program.tile_cols},
                {"period_slots", program.period_slots},
                {"bits_per_pixel", program.bits_per_pixel},
                {"words", words},
                {"word_bits", program.tile_cols * program.bits_per_pixel},
                {"program_bits", program.bits()}});
    run.say(fmt::format(
        "{}: {} words of {} bits, {} bits in all: {} slots of a tile of {} x {}, "
        "{} per pixel",
        options.output, words, program.tile_cols * program.bits_per_pixel, program.bits(),
        program.period_slots, program.tile_cols, program.tile_rows, program.bits_per_pixel));
}

}  // namespace

void add_schedule_compile(Command& schedule, Action& action) {
    Command command = schedule.add_command(
        "compile", "Write the program of the chip's sequencer, a memory image for $readmemh");
    const auto options = std::make_shared<CompileOptions>();
    add_schedule_choice(command, options->schedule);
    add_settings(command, {schedule_section(options->schedule)}, "change a key of the schedule");
    add_output(command, options->output, "memory image, .mem or .hex", kProgramName);
    command.footer(
        "Examples:\n"
        "  stipple schedule compile tiled -o tiled.mem\n"
        "  stipple schedule compile tiled -o tiled.mem --set schedule.tile_rows=8 --seed 7\n"
        "  stipple emulate scene -o clip.stipple --schedule tiled.mem");
    set_action(command, action, options, compile);
}

}  // namespace stipple
