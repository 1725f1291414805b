#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/arguments/common_options.h"
#include "apps/arguments/schedule.h"
#include "apps/output/json_file.h"
#include "apps/output/schedule_chart.h"
#include "apps/subcommands.h"
#include "io/output_names.h"
#include "study/report/schedule_text.h"

namespace stipple {
namespace {

struct ShowOptions {
    ScheduleChoice schedule;
    std::string output;  ///< empty: text
    int pixels = 10;     ///< as in the paper's Figure 1
    int slots = 0;       ///< 0: two periods, 24 to 64
};

void show(const ShowOptions& options, const RunOptions& run) {
    const NamedSchedule named = chosen_schedule(options.schedule);
    const ExposureSchedule& schedule = named.schedule;
    const int slots =
        options.slots > 0 ? options.slots : std::clamp(2 * schedule.period_slots(), 24, 64);
    const auto pixels = sample_pixels(schedule, options.schedule.shape, options.pixels);
    JsonFile json(run);
    if (!options.output.empty())
        draw_schedule(options.output, run.force, {named.name, schedule, pixels, slots});
    const ScheduleFigures figures = schedule_figures(schedule, options.schedule.shape);
    json.write(figures_json(named.name, figures));
    const std::string diagram =
        options.output.empty() ? diagram_text(schedule, pixels, slots) : options.output + ": ";
    run.say(diagram + figures_text(named.name, figures));
}

}  // namespace

void add_schedule_show(Command& schedule, Action& action) {
    Command command = schedule.add_command("show", "Timing diagram and figures of a schedule");
    const auto options = std::make_shared<ShowOptions>();
    add_schedule_choice(command, options->schedule);
    add_settings(command, {schedule_section(options->schedule)}, "change a key of the schedule");
    command.add_option("-o,--output", options->output, "image, .png or .svg")
        .default_text("text on standard output")
        .type_name("FILE")
        .output(kDiagramName);
    command
        .add_option("--pixels", options->pixels,
                    "number of pixels in the diagram, spread over the tile")
        .shows_default()
        .check(whole_check(1, 64))
        .type_name("N");
    command.add_option("--slots", options->slots, "number of slots in the diagram")
        .default_text("two periods, 24 to 64")
        .check(whole_check(1, 1024))
        .type_name("N");
    command.footer(
        "Examples:\n"
        "  stipple schedule show random\n"
        "  stipple schedule show two_bucket -o two_bucket.png --pixels 16");
    set_action(command, action, options, show);
}

}  // namespace stipple
