#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/arguments/common_options.h"
#include "apps/output/json_file.h"
#include "apps/subcommands.h"
#include "core/error.h"
#include "io/output_names.h"
#include "io/text_file.h"
#include "readout/schedules/code_schedule.h"
#include "readout/schedules/volume_schedule.h"
#include "stream/plain_text.h"
#include "stream/stream_header.h"
#include "study/report/schedule_text.h"

namespace stipple {
namespace {

struct ImportOptions {
    std::string volume;
    std::string output;
    std::string name;  ///< empty: the file's
    bool lengths = false;
    int period_slots = 0;
};

std::string check_name(const std::string& name) {
    if (!is_plain_text(name, false)) return "has control characters, or is not UTF-8";
    if (name.size() <= kMaxNameBytes) return {};
    return fmt::format("has {} bytes; {} is the most", name.size(), kMaxNameBytes);
}

/// Of a file of that name: its first bytes, as whole characters. \throws InputError
std::string name_of_file(const std::filesystem::path& file) {
    std::string name = file.stem().string();
    std::size_t bytes = std::min(name.size(), kMaxNameBytes);
    while (bytes < name.size() && (static_cast<unsigned char>(name[bytes]) & 0xC0U) == 0x80)
        --bytes;
    name.resize(bytes);
    const std::string problem = check_name(name);
    if (!problem.empty())
        throw InputError(file.string(),
                         fmt::format("its name {}; name the schedule with --name", problem));
    return name;
}

void import(const ImportOptions& options, const RunOptions& run) {
    if (options.period_slots > 0 && !options.lengths)
        throw InputError("--period", "goes with --lengths; masks have one slot per layer");
    const NpyVolume volume = read_npy_volume(
        options.volume, options.lengths ? NpyImages::kOneLayer : NpyImages::kRefused);
    const ExposureSchedule schedule =
        options.lengths ? lengths_schedule(volume, options.period_slots, options.volume)
                        : mask_schedule(volume, options.volume);
    const std::string name = options.name.empty() ? name_of_file(options.output) : options.name;
    JsonFile json(run);
    write_text_file(options.output, run.force, code_text(schedule, name));
    const ScheduleFigures figures =
        schedule_figures(schedule, {.rows = volume.rows, .cols = volume.cols, .planes = 1});
    json.write(figures_json(name, figures));
    run.say(fmt::format("{}: {}", options.output, figures_text(name, figures)));
}

}  // namespace

void add_schedule_import(Command& schedule, Action& action) {
    Command command =
        schedule.add_command("import", "A schedule from masks or exposure lengths in a .npy");
    const auto options = std::make_shared<ImportOptions>();
    command
        .add_option(
            "VOLUME", options->volume,
            ".npy of (slots, rows, columns): masks from 0 to 1 or to 255, grey ones too, an "
            "exposure for each pixel")
        .type_name("FILE.npy")
        .required()
        .input();
    add_output(command, options->output, "schedule file, .toml", kScheduleName);
    command.add_flag(
        "--lengths", options->lengths,
        "VOLUME holds lengths of 0 to 64 slots of successive exposures: (exposures, rows, "
        "columns), or (rows, columns) of one");
    command
        .add_option("--period", options->period_slots,
                    "with --lengths: slots after which the exposures repeat")
        .default_text("the largest sum of lengths")
        .check(whole_check(1, kMaxPeriodSlots))
        .type_name("N");
    command.add_option("--name", options->name, "name of the schedule")
        .default_text("that of the output")
        .check(check_name)
        .type_name("NAME");
    command.footer(
        "Examples:\n"
        "  stipple schedule import masks.npy -o masks.toml\n"
        "  stipple schedule import lengths.npy -o lengths.toml --lengths --period 16\n"
        "  stipple emulate scene -o clip.stipple --schedule masks.toml");
    set_action(command, action, options, import);
}

}  // namespace stipple
