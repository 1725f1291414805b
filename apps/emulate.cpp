#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "apps/arguments/common_options.h"
#include "apps/arguments/footage.h"
#include "apps/emulate.h"
#include "apps/emulate_switch.h"
#include "apps/interrupt.h"
#include "apps/output/emulation_text.h"
#include "apps/output/json_file.h"
#include "apps/output/leftovers.h"
#include "apps/output/progress.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "apps/stream_output.h"
#include "apps/subcommands.h"
#include "capture/recording/footage_notes.h"
#include "core/error.h"
#include "io/frame_writer.h"
#include "io/image_file.h"
#include "io/output_names.h"
#include "io/video_reader.h"
#include "readout/coded_sensor.h"
#include "readout/sensor_file.h"
#include "readout/timing/waveform_file.h"

namespace stipple {
namespace {

/// Null without --truth.
std::unique_ptr<FrameWriter> open_truth(const EmulateArguments& options, FrameShape shape,
                                        bool force) {
    if (options.truth.empty()) return nullptr;
    auto truth =
        std::make_unique<FrameWriter>(options.truth, shape, FrameWriterOptions{.force = force});
    say_leftover(options.truth);
    return truth;
}

/// What takes the frames of the footage.
struct SlotSink {
    SensorSwitches& switches;
    StreamRecorder& recorder;
    FrameWriter* truth;  ///< null: none
};

/// True at the end of the footage, false after a signal. \throws Interrupted, InputError without a
/// slot.
bool expose_slots(ResampledFootage& slots, const SlotSink& sink, Progress& progress,
                  const std::string& footage) {
    auto frame = slots.next();
    for (; !frame.empty() && stop_signal() == 0; frame = slots.next()) {
        sink.switches.apply(sink.recorder);
        sink.recorder.expose(frame);
        if (sink.truth != nullptr) sink.truth->write(frame);
        progress.advance();
    }
    if (progress.done() == 0) {
        throw_if_stopped();
        refuse_short_footage(footage);
    }
    return frame.empty();
}

void emulate(const EmulateArguments& options, const RunOptions& run) {
    EmulationInput input(options);
    const SensorSetup& setup = input.setup();
    ResampledFootage& slots = input.slots();
    SensorSwitches switches(options.switches, options.sensor, setup, input.footage().filter());
    JsonFile json(run);
    auto waveform = waveform_file(options.waveform, run.force, setup.timing.has_value());
    const auto truth = open_truth(options, setup.footage, run.force);
    std::optional<AttachedCalibration> calibration;
    if (!options.calibration.empty())
        calibration.emplace(options.calibration, options.output, setup, run);
    StreamRecorder recorder = open_stream_output(
        options.output, run, setup, options.source.origin([] { throw_if_stopped(); }),
        options.switches.empty() ? std::nullopt : std::optional(options.switches));
    Progress progress(run, "emulating", slots.slots());
    const bool at_end =
        expose_slots(slots, {switches, recorder, truth.get()}, progress, options.source.footage);
    if (truth) truth->finish();
    recorder.finish();
    if (calibration) calibration->write();
    if (waveform) {
        ReadoutCost cost(*setup.timing, setup.schedule.schedule, setup.shape,
                         recorder.emulator().readout_cost()->budget());
        waveform->write(cost, setup.params.name,
                        {0, std::min<std::int64_t>(options.waveform.slots, progress.done())},
                        [] { return stop_signal() == 0; });
    }
    if (at_end) say_warning(switches.unused_text(options.source.footage));
    if (at_end)
        for (const Message& note : end_notes(options.source.footage, input.footage(), setup.params,
                                             options.source.resampling.has_value()))
            say_warning(note);
    say_warning(
        zero_warning(options.output, recorder.zero_fraction(), calibration_of(setup.params)));
    const double slots_per_second = static_cast<double>(progress.done()) / progress.seconds();
    json.write(emulation_json(recorder, slots_per_second));
    run.say(fmt::format("{}: {}", options.output, emulation_text(recorder, slots_per_second)));
}

/// A piece is a part of the stream and of nothing else.
void check_part(const Command& command, const EmulateArguments& arguments) {
    command.refuse({"--truth", "--vcd", "--vcd-slots", "--calibration", "--switch"},
                   "is of all slots, which a part does not have; leave out one of them");
    check_part_folder(arguments.output);
}

/// The sensors of a rig have their options in its file.
void check_rig(const Command& command, const EmulateArguments& options) {
    if (options.rig.empty() && !options.rig_settings.empty())
        throw UsageError("--set", "rig." + options.rig_settings.front() +
                                      ": needs --rig; add it, or leave this out");
    if (options.rig.empty()) return;
    command.refuse(
        {"--sensor", "--schedule", "--seed", "--overrun", "--vcd", "--calibration", "--switch"},
        "is that of one sensor; write it into the file of the rig, or leave it out");
    command.refuse({"--part"}, "makes pieces of one stream; leave out one of them");
    if (!options.sensor.settings.empty() || !options.sensor.schedule_settings.empty())
        throw UsageError("--set", "changes one sensor; write --set rig.NAME.set=[...]");
    if (std::filesystem::path(options.output).extension() == ".stipple")
        throw UsageError("--output", "with --rig it is a folder, and has no extension");
}

/// `--rig`, and `--set` of all that has keys.
void add_rig(Command& command, EmulateArguments& arguments) {
    command
        .add_option("--rig", arguments.rig,
                    "several sensors on the scene, of \"stipple list rigs\"; FILE is a folder "
                    "(docs/rig.md)")
        .type_name("NAME|FILE")
        .listed("rigs")
        .input();
    auto sections = sensor_sections(arguments.sensor);
    sections.push_back({"rig", &arguments.rig_settings});
    add_settings(command, std::move(sections),
                 "change a key of the sensor, of the schedule or of the rig");
}

void check_waveform(const EmulateArguments& options) {
    if (!options.waveform.file.empty() && !options.switches.empty())
        throw UsageError("--vcd", "shows one schedule; leave out --switch, or this");
}

void warn_of_tone_mapped(const std::string& truth) {
    if (is_video_name(truth) || is_pipe(truth))
        say_warning(
            "{}: is tone-mapped to 8 bits, so it does not suit \"stipple compare\"; a "
            ".npy or a folder holds linear light",
            truth);
}

void emulate_all_or_part(const EmulateArguments& arguments, const RunOptions& run) {
    warn_of_tone_mapped(arguments.truth);
    if (!arguments.rig.empty())
        emulate_rig(arguments, run);
    else if (arguments.part.count > 0)
        emulate_part(arguments, run);
    else
        emulate(arguments, run);
}

}  // namespace

void add_emulate(Command& app, Action& action) {
    Command command = app.add_command("emulate", "Footage through the sensor to a sample stream");
    const auto options = std::make_shared<EmulateArguments>();
    command
        .add_option(
            "FOOTAGE", options->source.footage,
            fmt::format(
                "folder or printf pattern of {}, video or camera file, .npy, or a recording",
                image_format_names()))
        .required()
        .input();
    add_output(command, options->output, "sample stream", kStreamName);
    add_sensor_arguments(command, options->sensor);
    add_rig(command, *options);
    add_switches(command, options->switches);
    add_footage_arguments(command, options->source.reading);
    add_part_arguments(command, options->source.reading);
    add_resample_arguments(command, options->source.resampling, options->source.reading);
    add_max_value(command, options->source.reading.max_value);
    command
        .add_option("--truth", options->truth,
                    "write the reference light, in the formats of \"decode\"")
        .type_name("OUT")
        .output(kVideoName);
    command
        .add_option("--calibration", options->calibration,
                    "calibration of the chip; a copy, NAME.stcal beside NAME.stipple, tells it to "
                    "\"decode\"")
        .type_name("FILE")
        .input();
    add_waveform_arguments(command, options->waveform);
    add_part(command, options->part,
             "emulate part I of N into pieces of the folder FILE; those that are there are kept "
             "(docs/scaling.md)");
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple emulate scene -o clip.stipple\n"
        "  stipple emulate video.mp4 -o clip.stipple --transfer srgb --luminance --truth light\n"
        "  stipple emulate clip.raw --raw 1280x1024:bayergr16:hz=1057 -o clip.stipple\n"
        "  stipple emulate hdr.mp4 -o clip.stipple --transfer auto --resample flow --scale 2\n"
        "  stipple emulate frames/%04d.png -o clip.stipple --schedule tiled \\\n"
        "      --set sensor.read_noise_e=5 --set schedule.tile_rows=8\n"
        "  stipple emulate scene -o clip.stipple --switch 100:schedule=tiled,seed=2\n"
        "  stipple emulate scene -o tocci --rig tocci2011\n"
        "  stipple emulate film.npy -o pieces --part 3/16");
    set_action(command, action, options, emulate_all_or_part, [command, options] {
        options->source.reading.at_their_times = options->source.resampling.has_value();
        check_rig(command, *options);
        check_waveform(*options);
        if (options->part.count > 0) check_part(command, *options);
    });
}

}  // namespace stipple
