#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/arguments/footage.h"
#include "apps/arguments/output_names.h"
#include "apps/arguments/sensor.h"
#include "apps/interrupt.h"
#include "apps/report/emulation_text.h"
#include "apps/report/json_file.h"
#include "apps/report/leftovers.h"
#include "apps/report/number_text.h"
#include "apps/report/progress.h"
#include "apps/standard_error.h"
#include "apps/stream_output.h"
#include "apps/subcommands.h"
#include "capture/level_warning.h"
#include "capture/rate_warning.h"
#include "capture/recording/read_ahead.h"
#include "core/error.h"
#include "core/joined.h"
#include "io/frame_writer.h"
#include "readout/footage_origin.h"
#include "readout/timing/waveform_file.h"

namespace stipple {
namespace {

struct EmulateOptions {
    std::string footage;
    std::string output;
    std::string truth;  ///< empty: none
    WaveformOptions waveform;
    FootageOptions reading;
    ResampleChoice resample;
    SensorChoice sensor;
};

/// A warning about the faults of a recording named `file` that was read to its end: damage, no end,
/// missing or incomplete frames. Empty if it has none.
std::string recording_faults(const std::string& file, const RecordingFootage& footage) {
    auto faults = footage.recording().faults();
    if (footage.missing_frames() > 0)
        faults.push_back(
            fmt::format("lacks {}, missing or incomplete (the one before stands in for {})",
                        counted(footage.missing_frames(), "frame"), footage.held_slots()));
    if (faults.empty()) return {};
    return fmt::format("{}: {}; \"stipple capture replay\" lists the places", file, joined(faults));
}

void say_rate_warnings(const EmulateOptions& options, const ReadAhead& footage,
                       const SensorParams& sensor) {
    const auto hz = footage.video_hz();
    if (hz && options.resample.method.empty())
        say_warning(video_rate_warning(options.footage, *hz, sensor));
    if (const auto exposure_us = footage.exposure_us())
        say_warning(exposure_warning(options.footage, *exposure_us, sensor));
}

void emulate(const EmulateOptions& options, const RunOptions& run) {
    ReadAhead footage = read_footage(options.footage, options.reading);
    const SensorSetup setup = set_up_sensor(options.sensor, footage.shape(), footage.filter());
    say_warning(mosaic_warning(setup, footage.filter()));
    say_rate_warnings(options, footage, setup.params);
    say_warning(black_level_warning(options.footage, footage.traits(), setup.params));
    const SlotSource slots =
        slots_of(footage, options.footage, options.resample, options.reading, setup.params.slot_us);
    JsonFile json(run);
    auto waveform = waveform_file(options.waveform, run.force, setup.timing.has_value());
    std::optional<FrameWriter> truth;
    if (!options.truth.empty()) {
        truth.emplace(options.truth, setup.footage, FrameWriterOptions{.force = run.force});
        say_leftover(options.truth);
    }
    FootageOrigin origin = origin_of(options.footage, options.reading, [] { throw_if_stopped(); });
    origin.resample = options.resample.method;
    StreamRecorder recorder = open_stream_output(options.output, run, setup, origin);
    Progress progress(run, "emulating", slots.slots);
    auto frame = slots.next();
    for (; !frame.empty() && stop_signal() == 0; frame = slots.next()) {
        recorder.expose(frame);
        if (truth) truth->write(frame);
        progress.advance();
    }
    if (progress.done() == 0) throw_if_stopped();
    if (progress.done() == 0)
        throw InputError(options.footage, "is shorter than a slot of the sensor");
    if (truth) truth->finish();
    recorder.finish();
    if (waveform)
        waveform->write(*recorder.readout_cost(), setup.params.name,
                        {0, std::min<std::int64_t>(options.waveform.slots, progress.done())},
                        [] { return stop_signal() == 0; });
    if (frame.empty() && footage.recording() != nullptr) {
        const RecordingFootage& frames = *footage.recording();
        say_warning(recording_faults(options.footage, frames));
        if (options.resample.method.empty())
            say_warning(recording_rate_warning(options.footage, frames.rate(), setup.params));
    }
    const double slots_per_s = static_cast<double>(progress.done()) / progress.seconds();
    json.write(emulation_json(recorder, slots_per_s));
    run.say(fmt::format("{}: {}", options.output, emulation_text(recorder, slots_per_s)));
}

}  // namespace

void add_emulate(Command& app, Action& action) {
    Command command = app.add_command("emulate", "Footage through the sensor to a sample stream");
    const auto options = std::make_shared<EmulateOptions>();
    command
        .add_option(
            "FOOTAGE", options->footage,
            "folder or printf pattern of PNG, TIFF, EXR or DNG, video or camera file, .npy, or a "
            "recording")
        .required()
        .input();
    command.add_option("-o,--output", options->output, "sample stream")
        .type_name("FILE")
        .required()
        .output(kStreamName);
    add_sensor_arguments(command, options->sensor);
    add_settings(command, sensor_sections(options->sensor),
                 "change a key of the sensor or of the schedule");
    add_footage_arguments(command, options->reading);
    add_resample_arguments(command, options->resample, options->reading);
    add_max_value(command, options->reading.max_value);
    command
        .add_option("--truth", options->truth, "write the light that was emulated, as \"decode\"")
        .type_name("OUT")
        .output(kVideoName);
    add_waveform_arguments(command, options->waveform);
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple emulate scene -o clip.stipple\n"
        "  stipple emulate video.mp4 -o clip.stipple --transfer srgb --luminance --truth light\n"
        "  stipple emulate clip.raw --raw 1280x1024:bayergr16:hz=1057 -o clip.stipple\n"
        "  stipple emulate hdr.mp4 -o clip.stipple --transfer auto --resample flow --scale 2\n"
        "  stipple emulate frames/%04d.png -o clip.stipple --schedule tiled \\\n"
        "      --set sensor.read_noise_e=5 --set schedule.tile_rows=8");
    set_action(command, action, options, emulate);
}

}  // namespace stipple
