#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/arguments/common_options.h"
#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/leftovers.h"
#include "apps/output/progress.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "core/error.h"
#include "session/measurement_export.h"
#include "session/stream_calibration.h"
#include "stream/stream_figures.h"
#include "study/report/json_figures.h"

namespace stipple {
namespace {

struct ExportArguments {
    std::string stream;
    std::string output;
    std::string calibration;
    ExportOptions options;
};

void export_stream(const ExportArguments& arguments, const RunOptions& run) {
    JsonFile json(run);
    PendingOutput output(arguments.output, run.force);
    say_leftover(arguments.output);
    StreamReader stream(arguments.stream);
    say_warning(calibrate(stream, calibration_choice(arguments.calibration)));
    Progress progress(run, "reading", stream.slots());
    const auto result = export_measurements(stream, arguments.options, [&](double slots) {
        progress.reach(slots);
        return stop_signal() == 0;
    });
    if (!result) throw Interrupted{};
    if (!undamaged(stream.report()))
        say_warning("{}: {}", arguments.stream, damage_text(stream.report()));
    write_export(*result, output);
    json.write(json_of([&](const auto& add) { visit_export_figures(*result, add); }));
    run.say(fmt::format("{}: {} of {} x {} pixels, {} {} masks{}, {} saturated", arguments.output,
                        counted(result->measurements, "measurement"), result->cols, result->rows,
                        result->slots, result->weighted ? "grey" : "binary",
                        arguments.options.masks == ExportMasks::kOwn ? " each" : "",
                        counted(static_cast<std::int64_t>(result->saturated), "sample")));
}

}  // namespace

void add_export(Command& app, Action& action) {
    Command command = app.add_command(
        "export", "Sample stream to measurements with their masks, as of a coded aperture");
    const auto arguments = std::make_shared<ExportArguments>();
    command.add_option("STREAM", arguments->stream, "sample stream").required().input();
    add_output(command, arguments->output, "arrays, .npz or .mat: \"mask\", \"meas\" and others",
               kArraysName);
    command
        .add_choice("--masks", arguments->options.masks, kExportMasks,
                    "the measurements share the masks of a period, or have their own")
        .type_name("NAME");
    command
        .add_parsed(
            "--slots",
            [arguments](const std::string& text) {
                try {
                    arguments->options.slots = parse_frame_range(text);
                } catch (const InputError& e) {
                    throw UsageError("--slots", e.what());
                }
            },
            "slots A to B - 1 of the stream; A or B may be left out")
        .default_text("all, of shared masks whole periods")
        .type_name("A:B");
    command
        .add_option("--calibration", arguments->calibration,
                    "calibration of the chip, which \"stipple calibrate\" wrote; none: do not "
                    "calibrate")
        .default_text("NAME.stcal beside a stream NAME.stipple, if it is there")
        .type_name("FILE")
        .input();
    command.footer(
        "Examples:\n"
        "  stipple emulate scene -o clip.stipple --schedule single_bump --luminance\n"
        "  stipple export clip.stipple -o clip.mat\n"
        "  stipple export tiled.stipple -o tiled.npz --masks own --slots 30:46\n"
        "  stipple import clip.mat -o again.stipple");
    set_action(command, action, arguments, export_stream);
}

}  // namespace stipple
