#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>

#include "apps/arguments/checks.h"
#include "apps/arguments/footage.h"
#include "apps/interrupt.h"
#include "apps/report/json_file.h"
#include "apps/report/number_text.h"
#include "apps/report/progress.h"
#include "apps/report/quality_json.h"
#include "apps/standard_error.h"
#include "apps/subcommands.h"
#include "capture/recording/read_ahead.h"
#include "core/error.h"
#include "metrics/video_quality.h"

namespace stipple {
namespace {

struct CompareOptions {
    std::string result;
    std::string reference;
    FootageOptions footage;  ///< of the reference
    QualityOptions quality;
    std::int64_t until = 0;  ///< frames of each; 0: all, of which both must have as many
};

[[noreturn]] void fail_shape(const CompareOptions& options, FrameShape result, FrameShape wanted) {
    const bool same_size = result.rows == wanted.rows && result.cols == wanted.cols;
    throw InputError(
        options.result,
        fmt::format("has frames of {} x {} x {} (rows x columns x planes), but the "
                    "reference \"{}\" has {} x {} x {}{}",
                    result.rows, result.cols, result.planes, options.reference, wanted.rows,
                    wanted.cols, wanted.planes,
                    same_size && result.planes != wanted.planes ? "; try --luminance" : ""));
}

/// \throws InputError: the result or the reference ends after `frames`.
[[noreturn]] void fail_length(const CompareOptions& options, bool is_result, std::int64_t frames) {
    const auto& [shorter, longer] = is_result ? std::tie(options.result, options.reference)
                                              : std::tie(options.reference, options.result);
    const std::string too_early =
        options.until > 0 ? fmt::format("--until {}", options.until)
                          : fmt::format("\"{}\" does; --until {} compares as many", longer, frames);
    throw InputError(shorter,
                     fmt::format("ends after {}, before {}", counted(frames, "frame"), too_early));
}

/// Adds up the frames. \throws InputError if one video ends before the other, or before --until.
void compare_frames(const CompareOptions& options, ReadAhead& result, ReadAhead& reference,
                    QualityMeter& meter, Progress& progress) {
    while (options.until == 0 || progress.done() < options.until) {
        throw_if_stopped();
        const auto a = result.next();
        const auto b = reference.next();
        if (a.empty() && b.empty() && options.until == 0) return;
        if (a.empty() || b.empty()) fail_length(options, a.empty(), progress.done());
        meter.add(a, b);
        progress.advance();
    }
}

/// The number of frames, if it is known.
std::optional<std::int64_t> frames_to_come(const CompareOptions& options,
                                           const ReadAhead& reference) {
    if (options.until > 0) return options.until;
    return reference.slots();
}

void compare(const CompareOptions& options, const RunOptions& run) {
    JsonFile json(run);
    ReadAhead result = read_footage(
        options.result,
        {.transfer = Transfer::kLinear, .luminance = options.footage.luminance, .max_value = {}});
    if (result.gamma_coded())
        say_warning(
            fmt::format("{}: is not linear light, as RESULT has to be: .mp4, .mkv and .png of "
                        "stipple are tone-mapped; compare the .npy or the folder",
                        options.result));
    ReadAhead reference = read_footage(options.reference, options.footage);
    if (result.shape() != reference.shape()) fail_shape(options, result.shape(), reference.shape());
    QualityMeter meter(reference.shape(), options.quality);
    VideoQuality quality;
    {
        Progress progress(run, "comparing", frames_to_come(options, reference));
        compare_frames(options, result, reference, meter, progress);
        quality = meter.quality();
    }
    auto figures = quality_json(quality);
    figures["peak"] = options.quality.peak;
    figures["cd_per_unit"] = options.quality.unit_cd_per_m2;
    json.write(figures);
    run.say(fmt::format(
        "PSNR        {:7.2f} dB  linear, peak {:g}\n"
        "PSNR gamma  {:7.2f} dB  clamped to 0..1, power 1/2.2\n"
        "PSNR frames {:7.2f} dB  linear, mean of the frames' values\n"
        "PU21-PSNR   {:7.2f} dB  1.0 = {:g} cd/m2\n"
        "SSIM        {:7.4f}     clamped to 0..1, power 1/2.2",
        quality.psnr_db, options.quality.peak, quality.psnr_gamma_db, quality.psnr_frame_mean_db,
        quality.pu21_psnr_db, options.quality.unit_cd_per_m2, quality.ssim));
}

}  // namespace

void add_compare(Command& app, Action& action) {
    Command command = app.add_command("compare", "Measure a video against its reference");
    const auto options = std::make_shared<CompareOptions>();
    command.add_option("RESULT", options->result, "video in linear light").required().input();
    command.add_option("REFERENCE", options->reference, "footage").required().input();
    command.add_option("--until", options->until, "compare the first N frames of each")
        .default_text("all, of which both have as many")
        .check(frames_check())
        .type_name("N");
    command
        .add_option("--margin", options->quality.margin,
                    "leave out the first N and the last N of these frames")
        .shows_default()
        .check(whole_check(0, 1'000'000))
        .type_name("N");
    add_max_value(command, options->quality.max_value);
    add_footage_arguments(command, options->footage, "REFERENCE");
    command
        .add_option(
            "--peak", options->quality.peak,
            "peak of PSNR and PU21-PSNR; with --max-value 2, a peak of 2 raises the PSNR by 6 dB")
        .shows_default()
        .check(positive_check())
        .type_name("LIGHT");
    command
        .add_option(
            "--cd-per-unit", options->quality.unit_cd_per_m2,
            "luminance of light 1.0 for PU21, in cd/m2; an HDR display reaches 1000 and more")
        .shows_default()
        .check(positive_check())
        .type_name("L");
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple compare decoded scene --margin 4 --max-value 2\n"
        "  stipple compare preview scene --until 60\n"
        "  stipple compare decoded.npy footage.npy --max-value 2 --peak 2 --cd-per-unit 1000");
    set_action(command, action, options, compare);
}

}  // namespace stipple
