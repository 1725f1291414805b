#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/arguments/common_options.h"
#include "apps/arguments/schedule.h"
#include "apps/output/json_file.h"
#include "apps/subcommands.h"
#include "io/output_names.h"
#include "io/text_file.h"
#include "readout/schedules/code_schedule.h"
#include "study/report/schedule_text.h"

namespace stipple {
namespace {

struct MakeOptions {
    ScheduleChoice schedule;
    std::string output;
};

void make(const MakeOptions& options, const RunOptions& run) {
    const NamedSchedule named = chosen_schedule(options.schedule);
    JsonFile json(run);
    write_text_file(options.output, run.force, code_text(named.schedule, named.name));
    const ScheduleFigures figures = schedule_figures(named.schedule, options.schedule.shape);
    json.write(figures_json(named.name, figures));
    run.say(fmt::format("{}: {}", options.output, figures_text(named.name, figures)));
}

}  // namespace

void add_schedule_make(Command& schedule, Action& action) {
    Command command =
        schedule.add_command("make", "Write out what each pixel of a schedule does (kind code)");
    const auto options = std::make_shared<MakeOptions>();
    add_schedule_choice(command, options->schedule);
    add_settings(command, {schedule_section(options->schedule)}, "change a key of the schedule");
    add_output(command, options->output, "schedule file, .toml", kScheduleName);
    command.footer(
        "Examples:\n"
        "  stipple schedule make two_bucket -o mine.toml --set schedule.tile_rows=4 --set "
        "schedule.tile_cols=4\n"
        "  stipple schedule make random -o tile.toml --size 32x32 --seed 7");
    set_action(command, action, options, make);
}

}  // namespace stipple
