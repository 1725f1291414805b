#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "apps/arguments/common_options.h"
#include "apps/arguments/footage.h"
#include "apps/arguments/sensor.h"
#include "apps/emulate.h"
#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/leftovers.h"
#include "apps/output/progress.h"
#include "apps/subcommands.h"
#include "core/error.h"
#include "core/index.h"
#include "readout/chip/chip_project.h"
#include "readout/provenance.h"

namespace stipple {
namespace {

constexpr int kMaxSlots = 1'000'000;

struct RtlOptions {
    EmulateArguments emulation;
    FrameShape size{.rows = 0, .cols = 0, .planes = 1};  ///< 0: of the footage, or small
    int slots = 0;                                       ///< 0: two periods and 3
};

/// A size that simulates in seconds: 16 rows of about 32 columns.
FrameShape small_size(const ReadoutTiming& timing) {
    const int step = std::max(1, std::lcm(timing.addressing.channels, timing.columns_per_adc));
    const int cols = (32 + step - 1) / step * step;
    return {.rows = std::min(16, timing.rows), .cols = std::min(cols, timing.cols), .planes = 1};
}

/// Light that rises along rows and columns, and moves.
std::vector<float> ramp(FrameShape shape, int slot) {
    std::vector<float> frame;
    for (int row = 0; row < shape.rows; ++row)
        for (int col = 0; col < shape.cols; ++col)
            frame.push_back(static_cast<float>((row + col + 3 * slot) % 64) / 64);
    return frame;
}

int default_slots(const SensorSetup& setup) {
    return std::min(64, 2 * setup.schedule.schedule.period_slots() + 3);
}

/// What the chip films.
struct Film {
    SensorSetup setup;
    FootageOrigin origin = {};
    std::vector<std::vector<float>> frames = {};
};

Film ramp_film(const RtlOptions& options) {
    const SensorChoice& choice = options.emulation.sensor;
    const SensorDescription sensor = read_sensor_file(choice);
    if (!sensor.timing)
        throw InputError(fmt::format("sensor \"{}\"", choice.sensor), no_timing_text());
    const FrameShape shape = options.size.rows > 0 ? options.size : small_size(*sensor.timing);
    Film film{.setup = set_up_sensor(sensor, choice, shape)};
    const int slots = options.slots > 0 ? options.slots : default_slots(film.setup);
    film.frames.reserve(index(slots));
    for (int slot = 0; slot < slots; ++slot) film.frames.push_back(ramp(film.setup.footage, slot));
    return film;
}

Film footage_film(const RtlOptions& options) {
    EmulationInput input(options.emulation);
    Film film{.setup = input.setup(),
              .origin = options.emulation.source.origin([] { throw_if_stopped(); })};
    const int slots = options.slots > 0 ? options.slots : default_slots(film.setup);
    for (auto frame = input.slots().next(); !frame.empty() && film.frames.size() < index(slots);
         frame = input.slots().next()) {
        throw_if_stopped();
        film.frames.emplace_back(frame.begin(), frame.end());
    }
    if (film.frames.empty()) refuse_short_footage(options.emulation.source.footage);
    return film;
}

void write_rtl(const RtlOptions& options, const RunOptions& run) {
    const std::string& output = options.emulation.output;
    Film film =
        options.emulation.source.footage.empty() ? ramp_film(options) : footage_film(options);
    cut_array(film.setup);
    JsonFile json(run);
    PendingOutput folder(output, run.force, OutputKind::kFolder, ChipProject::is_own);
    say_leftover(output);
    const auto slots = static_cast<int>(film.frames.size());
    ChipProject project(folder.partial(), film.setup, slots,
                        provenance_of(film.setup, film.origin));
    Progress progress(run, "emulating", slots, "slot");
    for (const std::vector<float>& frame : film.frames) {
        throw_if_stopped();
        project.expose(frame);
        progress.advance();
    }
    project.finish();
    folder.commit();
    const ChipParameters& chip = project.chip();
    json.write({{"sensor", film.setup.params.name},
                {"schedule", film.setup.schedule.name},
                {"rows", chip.rows},
                {"cols", chip.cols},
                {"channels", chip.channels},
                {"tile_rows", chip.tile_rows},
                {"tile_cols", chip.tile_cols},
                {"depth", chip.depth},
                {"pixel_bits", chip.pixel_bits},
                {"word_bytes", chip.word_bytes},
                {"slots", slots},
                {"slot_clocks", project.capture().budget.clocks}});
    run.say(fmt::format(
        "{}: a chip of {} x {} pixels, {} channels, a tile of {} x {} in {} slots; capture of {} "
        "slots of {} clocks\n\"make\" there simulates it and compares its packets; see README.md",
        output, chip.cols, chip.rows, chip.channels, chip.tile_cols, chip.tile_rows, chip.depth,
        slots, project.capture().budget.clocks));
}

}  // namespace

void add_rtl(Command& app, Action& action) {
    Command command =
        app.add_command("rtl", "A sensor as a chip in SystemVerilog, with its test bench");
    const auto options = std::make_shared<RtlOptions>();
    EmulateArguments& emulation = options->emulation;
    emulation.sensor.schedule = "tiled";
    add_sensor_arguments(command, emulation.sensor);
    command
        .add_option("--footage", emulation.source.footage,
                    "what the chip films, as in \"emulate\"; the array has its size")
        .type_name("FOOTAGE")
        .default_text("a ramp along rows and columns")
        .input();
    add_size(command, "--size", options->size, {1, kMaxFrameSide},
             "columns and rows of the array; a slot shortens in proportion to the rows")
        .default_text("about 32x16, which simulates in seconds");
    command.add_option("--slots", options->slots, "slots of the capture")
        .check(whole_check(1, kMaxSlots))
        .type_name("N")
        .default_text("two periods and 3, at most 64");
    add_settings(command, sensor_sections(emulation.sensor),
                 "change a key of the sensor or of the schedule");
    add_output(command, emulation.output, "folder of the design", {}, "DIR");
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple rtl --sensor lux1310 --schedule tiled -o chip && make -C chip\n"
        "  stipple rtl --sensor vita --schedule hardware_tiled --size 1280x1024 -o whole\n"
        "  stipple rtl --sensor lux1310 --footage scene --slots 20 -o chip");
    set_action(command, action, options, write_rtl, [command, options] {
        if (!options->emulation.source.footage.empty())
            command.refuse({"--size"}, "is that of the footage; leave out one of them");
    });
}

}  // namespace stipple
