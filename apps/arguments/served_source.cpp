#include "apps/arguments/served_source.h"

#include <fmt/format.h>

#include "apps/arguments/common_options.h"
#include "apps/arguments/footage.h"
#include "apps/arguments/sensor.h"
#include "apps/arguments/settings.h"
#include "apps/interrupt.h"
#include "apps/standard_streams.h"
#include "capture/recording/recording_footage.h"
#include "capture/serve/served_frames.h"
#include "core/error.h"
#include "core/text.h"
#include "readout/footage_origin.h"

namespace stipple {
namespace {

void say_warnings_of_footage(const ServedSourceChoice& choice) {
    FootageReader reader(choice.path, choice.reading);
    for (const Message& warning : reader.take_warnings()) say_warning(warning);
}

std::unique_ptr<FrameSource> open_footage(const ServedSourceChoice& choice) {
    const PixelFormat* format = nullptr;
    if (!choice.format.empty()) {
        format = pixel_format_named(choice.format);
        if (format == nullptr)
            throw InputError(
                "--format " + choice.format,
                "is not a pixel format; " + suggestion(choice.format, names_of(pixel_formats())));
    }
    return std::make_unique<FootageFrames>(choice.path, choice.reading,
                                           choice.frames_hz.value_or(ServedImage::kUsualFramesHz),
                                           format);
}

}  // namespace

void add_served_source(Command& command, ServedSourceChoice& source) {
    command
        .add_option("SOURCE", source.path,
                    "footage, or in mode frames a recording of \"capture record\"")
        .required()
        .input();
    command
        .add_choice("--mode", source.mode,
                    {{"frames", ServedMode::kFrames}, {"coded", ServedMode::kCoded}},
                    "send frames as they are, or the coded samples of a sensor")
        .type_name("MODE");
    command.add_option("--frames-hz", source.frames_hz, "frame rate, or slot rate of mode coded")
        .default_text(fmt::format("as recorded; in mode coded as the sensor; else {}",
                                  ServedImage::kUsualFramesHz))
        .check(number_check(ServedImage::kMinFramesHz, ServedImage::kMaxFramesHz))
        .type_name("HZ");
    command.add_option("--format", source.format, "pixel format of footage, in mode frames")
        .default_text("Mono8, RGB8 for colour")
        .type_name("NAME");
    add_sensor_arguments(command, source.sensor);
    add_settings(command, sensor_sections(source.sensor),
                 "change a key of the sensor or of the schedule");
    add_footage_arguments(command, source.reading);
    add_max_value(command, source.reading.max_value);
}

std::unique_ptr<FrameSource> open_served_source(const ServedSourceChoice& choice) {
    const bool coded = choice.mode == ServedMode::kCoded;
    if (coded || !is_recording(choice.path)) say_warnings_of_footage(choice);
    if (coded)
        return std::make_unique<CodedFrames>(
            choice.path, origin_of(choice.path, choice.reading, [] { throw_if_stopped(); }),
            choice.sensor, choice.frames_hz);
    if (!is_recording(choice.path)) return open_footage(choice);
    if (!choice.format.empty())
        throw InputError("--format " + choice.format,
                         "a recording is served in the format it was recorded in; leave it out");
    check_recording_options(choice.path, choice.reading);
    return std::make_unique<RecordingFrames>(choice.path, choice.frames_hz);
}

}  // namespace stipple
