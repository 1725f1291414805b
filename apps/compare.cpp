#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "apps/arguments/common_options.h"
#include "apps/arguments/footage.h"
#include "apps/interrupt.h"
#include "apps/output/difference_output.h"
#include "apps/output/json_file.h"
#include "apps/output/progress.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "capture/recording/footage_notes.h"
#include "capture/recording/read_ahead.h"
#include "core/error.h"
#include "core/text.h"
#include "io/footage_files.h"
#include "io/output_names.h"
#include "io/pending_output.h"
#include "io/text_file.h"
#include "study/metrics/video_quality.h"
#include "study/report/quality_metrics.h"

namespace stipple {
namespace {

struct CompareOptions {
    std::string result;
    std::string reference;
    FootageOptions footage;  ///< of the reference
    std::optional<Transfer> result_transfer;
    QualityOptions quality;
    std::int64_t until = 0;            ///< frames of each; 0: as many as both have
    std::vector<std::string> metrics;  ///< names; empty: the default ones
    double pixels_per_degree = 60;     ///< of metric pu21-csf-psnr
    std::string csv;                   ///< this and the following: empty: none
    std::string chart;
    std::string difference;
};

[[noreturn]] void fail_shape(const CompareOptions& options, FrameShape result, FrameShape wanted) {
    const bool same_size = result.rows == wanted.rows && result.cols == wanted.cols;
    throw InputError(
        options.result,
        shape_difference(result, wanted,
                         fmt::format("but the reference \"{}\" has", options.reference)) +
            (same_size && result.planes != wanted.planes ? "; try --luminance" : ""));
}

/// \throws InputError for a video that ends before --until.
void check_length(const CompareOptions& options, bool is_result, std::int64_t frames) {
    if (options.until == 0) return;
    throw InputError(
        is_result ? options.result : options.reference,
        fmt::format("ends after {}, before --until {}", counted(frames, "frame"), options.until));
}

/// \throws InputError for a table or chart that would be empty.
void check_frame_metrics(const CompareOptions& options, const QualityMetrics& metrics) {
    if (options.csv.empty() && options.chart.empty()) return;
    if (std::ranges::any_of(metrics, &QualityMetric::of_a_frame)) return;
    throw InputError(options.csv.empty() ? "--chart" : "--csv",
                     "shows figures of each frame, and no --metric that is given has one");
}

/// The video that goes on after the last frame of the other one.
enum class Longer { kNone, kResult, kReference };

/// Calls `add` with the frames that both have. \throws InputError if one ends before --until.
template <typename Add>
Longer compare_frames(const CompareOptions& options, ReadAhead& result, ReadAhead& reference,
                      Progress& progress, const Add& add) {
    while (options.until == 0 || progress.done() < options.until) {
        throw_if_stopped();
        const auto a = result.next();
        const auto b = reference.next();
        if (a.empty() || b.empty()) {
            check_length(options, a.empty(), progress.done());
            if (a.empty() && b.empty()) return Longer::kNone;
            return a.empty() ? Longer::kReference : Longer::kResult;
        }
        add(a, b);
        progress.advance();
    }
    return Longer::kNone;
}

void say_overlap(const CompareOptions& options, Longer longer, std::int64_t frames) {
    if (longer == Longer::kNone) return;
    const auto [shorter_name, longer_name] = longer == Longer::kResult
                                                 ? std::tie(options.reference, options.result)
                                                 : std::tie(options.result, options.reference);
    say_warning(fmt::format("{}: ends after {}, before \"{}\" does; these are compared",
                            shorter_name, counted(frames, "frame"), longer_name));
}

/// The number of frames, if it is known.
std::optional<std::int64_t> frames_to_come(const CompareOptions& options,
                                           const ReadAhead& reference) {
    if (options.until > 0) return options.until;
    return reference.slots();
}

/// The outputs beside JSON, opened before the work.
class Outputs {
  public:
    Outputs(const CompareOptions& options, FrameShape shape, bool force) {
        if (!options.csv.empty()) csv_.emplace(options.csv, force);
        if (!options.chart.empty()) chart_.emplace(options.chart, force);
        if (!options.difference.empty())
            difference_.emplace(options.difference, shape, force, options.quality.max_value);
    }

    void add(std::span<const float> result, std::span<const float> reference) {
        if (difference_) difference_->add(result, reference);
    }

    void finish(const FrameTable& table) {
        if (csv_) write_text(*csv_, table_csv(table));
        if (difference_) difference_->finish();
    }
    /// Last, because gnuplot may be missing. \throws as draw_chart.
    void draw(const FrameTable& table) {
        if (!chart_) return;
        write_text(*chart_, table_chart(table, lower_extension(chart_->final_path())));
    }

  private:
    std::optional<PendingOutput> csv_;
    std::optional<PendingOutput> chart_;
    std::optional<DifferenceOutput> difference_;
};

ReadAhead read_result(const CompareOptions& options) {
    return read_footage(options.result,
                        {.transfer = options.result_transfer.value_or(Transfer::kLinear),
                         .luminance = options.footage.luminance,
                         .max_value = {},
                         .negative = true});
}

QualityOptions quality_options(const CompareOptions& options, const QualityMetrics& metrics) {
    QualityOptions quality = options.quality;
    quality.pu21_ssim = has_metric(metrics, "pu21-ssim");
    if (has_metric(metrics, "pu21-csf-psnr")) quality.pixels_per_degree = options.pixels_per_degree;
    return quality;
}

void warn_of_gamma(const CompareOptions& options, const ReadAhead& result) {
    if (!options.result_transfer && result.gamma_coded())
        say_warning(
            fmt::format("{}: is not linear light, as RESULT has to be: .mp4, .mkv and .png of "
                        "stipple are tone-mapped, compare the .npy or the folder; for results of "
                        "others, give --result-transfer",
                        options.result));
}

void compare(const CompareOptions& options, const RunOptions& run) {
    const QualityMetrics metrics = chosen_metrics(options.metrics);
    check_frame_metrics(options, metrics);
    const QualityOptions quality = quality_options(options, metrics);
    JsonFile json(run);
    ReadAhead result = read_result(options);
    warn_of_gamma(options, result);
    ReadAhead reference = read_footage(options.reference, options.footage);
    if (result.shape() != reference.shape()) fail_shape(options, result.shape(), reference.shape());
    QualityMeter meter(reference.shape(), quality);
    Outputs outputs(options, reference.shape(), run.force);
    std::int64_t frames = 0;
    Longer longer = Longer::kNone;
    {
        Progress progress(run, "comparing", frames_to_come(options, reference));
        longer = compare_frames(options, result, reference, progress, [&](auto a, auto b) {
            meter.add(a, b);
            outputs.add(a, b);
        });
        frames = progress.done();
    }
    const VideoQuality found = meter.quality();
    say_overlap(options, longer, frames);
    say_warning(recording_note(options.result, result));
    say_warning(recording_note(options.reference, reference));
    const FrameTable table{metrics, meter.frame_qualities(), quality.margin};
    outputs.finish(table);
    auto figures = metrics_json(metrics, found);
    figures["peak"] = quality.peak;
    figures["cd_per_unit"] = quality.unit_cd_per_m2;
    if (quality.pixels_per_degree) figures["pixels_per_degree"] = *quality.pixels_per_degree;
    figures["frames"] = frames;
    figures["longer"] = nullptr;
    if (longer != Longer::kNone)
        figures["longer"] = longer == Longer::kResult ? "result" : "reference";
    json.write(figures);
    run.say(metrics_text(metrics, found, quality));
    outputs.draw(table);
}

/// `--metric` and what it needs.
void add_metric_arguments(Command& command, CompareOptions& options) {
    command.add_list("--metric", options.metrics, "figures to give")
        .default_text("all but pu21-ssim and pu21-csf-psnr")
        .split_at_commas()
        .one_of(names_of(quality_metrics()));
    command
        .add_option(
            "--pixels-per-degree", options.pixels_per_degree,
            "pixels in a degree of visual angle, for pu21-csf-psnr; 60: an HD picture at 3.2 "
            "times its height")
        .shows_default()
        .check(positive_check())
        .type_name("P");
}

void add_quality_arguments(Command& command, CompareOptions& options) {
    command
        .add_option(
            "--peak", options.quality.peak,
            "peak of PSNR and PU21-PSNR; with --max-value 2, a peak of 2 raises the PSNR by 6 dB")
        .shows_default()
        .check(positive_check())
        .type_name("LIGHT");
    command
        .add_option(
            "--cd-per-unit", options.quality.unit_cd_per_m2,
            "luminance of light 1.0 for PU21, in cd/m2; an HDR display reaches 1000 and more")
        .shows_default()
        .check(positive_check())
        .type_name("L");
    add_metric_arguments(command, options);
}

void add_compare_outputs(Command& command, CompareOptions& options) {
    command
        .add_option("--csv", options.csv,
                    "table of the figures of each frame, without those left out by --margin")
        .type_name("FILE")
        .output(kTableName);
    command.add_option("--chart", options.chart, "the same as a chart, .png or .svg; needs gnuplot")
        .type_name("FILE")
        .output(kDiagramName);
    command
        .add_option(
            "--difference", options.difference,
            "absolute difference of light: a folder of EXR or a .npy, or as .png the root of "
            "its mean square over the frames, tone-mapped")
        .type_name("OUT")
        .output(kDifferenceName);
}

}  // namespace

void add_compare(Command& app, Action& action) {
    Command command = app.add_command("compare", "Measure a video against its reference");
    const auto options = std::make_shared<CompareOptions>();
    command.add_option("RESULT", options->result, "video in linear light").required().input();
    command.add_option("REFERENCE", options->reference, "footage").required().input();
    command
        .add_option("--until", options->until,
                    "compare the first N frames of each, which both must have")
        .default_text("all that both have")
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
        .add_choice("--result-transfer", options->result_transfer, kTransfers,
                    "transfer function of RESULT; auto: the declared one")
        .default_text("linear")
        .type_name("NAME");
    add_quality_arguments(command, *options);
    add_compare_outputs(command, *options);
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple compare decoded scene --margin 4 --max-value 2\n"
        "  stipple compare preview scene --until 60\n"
        "  stipple compare decoded.npy footage.npy --max-value 2 --peak 2 --cd-per-unit 1000\n"
        "  stipple compare decoded scene --csv frames.csv --difference difference\n"
        "  stipple compare decoded scene --metric pu21-psnr,pu21-ssim --chart frames.png");
    set_action(command, action, options, compare);
}

}  // namespace stipple
