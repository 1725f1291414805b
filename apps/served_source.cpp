#include "apps/served_source.h"

#include <fmt/format.h>

#include "apps/arguments/checks.h"
#include "apps/arguments/footage.h"
#include "apps/footage_origin.h"
#include "apps/report/session_report.h"
#include "capture/serve/coded_frames.h"
#include "capture/serve/footage_frames.h"
#include "capture/serve/recording_frames.h"
#include "core/error.h"
#include "core/suggestion.h"

namespace stipple {
namespace {

constexpr double kFramesPerS = 25;

void say_warnings_of_footage(const ServedSourceChoice& choice) {
    FootageReader reader(choice.path, choice.reading);
    for (const std::string& warning : reader.take_warnings()) say_warning(warning);
}

std::unique_ptr<FrameSource> open_footage(const ServedSourceChoice& choice) {
    const PixelFormat* format = nullptr;
    if (!choice.format.empty()) {
        format = pixel_format_named(choice.format);
        if (format == nullptr)
            throw InputError(
                "--format " + choice.format,
                "is no pixel format; " + suggestion(choice.format, names_of(pixel_formats())));
    }
    return std::make_unique<FootageFrames>(choice.path, choice.reading,
                                           choice.frames_per_s.value_or(kFramesPerS), format);
}

}  // namespace

std::unique_ptr<FrameSource> open_served_source(const ServedSourceChoice& choice) {
    if (choice.mode == "coded" || !is_recording(choice.path)) say_warnings_of_footage(choice);
    if (choice.mode == "coded")
        return std::make_unique<CodedFrames>(choice.path, origin_of(choice.path, choice.reading),
                                             choice.sensor, choice.frames_per_s);
    if (!is_recording(choice.path)) return open_footage(choice);
    if (!choice.format.empty())
        throw InputError("--format " + choice.format,
                         "a recording is served in the format it was recorded in; leave it out");
    check_recording_options(choice.path, choice.reading);
    return std::make_unique<RecordingFrames>(choice.path, choice.frames_per_s);
}

}  // namespace stipple
