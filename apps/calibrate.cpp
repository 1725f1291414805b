#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/arguments/common_options.h"
#include "apps/calibrate.h"
#include "apps/output/json_file.h"
#include "apps/output/leftovers.h"
#include "apps/output/text_layout.h"
#include "apps/subcommands.h"
#include "calibration/calibration_file.h"
#include "calibration/chip_estimate.h"
#include "io/text_file.h"

namespace stipple {
namespace {

struct CalibrateOptions {
    SeriesArguments series;
    bool no_dark_current = false;
    SceneArguments scene;
    std::string output;
};

/// Null if nothing is known.
nlohmann::ordered_json json_of(const ResponseFit& response) {
    if (response.levels == 0) return nullptr;
    return {{"levels", response.levels},
            {"linear", response.table.linear_dn.empty()},
            {"brightest_dn", response.brightest_dn},
            {"bend_dn", response.bend_dn},
            {"error_dn", response.error_dn}};
}

std::string text_of(const ResponseFit& response) {
    if (response.levels == 0) return "not measured: it takes three levels of light";
    if (response.table.linear_dn.empty())
        return fmt::format("linear up to {} DN by {} levels", rounded(response.brightest_dn),
                           response.levels);
    return fmt::format("{} DN stand for {} +- {} linear DN, by {} levels",
                       rounded(response.brightest_dn),
                       rounded(response.brightest_dn + response.bend_dn),
                       rounded(response.error_dn), response.levels);
}

nlohmann::ordered_json json_of(const ChipEstimate& estimate, const ChipFigures& figures) {
    const auto map = [](const MapFigures& stored,
                        const PatternVariances& p) -> nlohmann::ordered_json {
        return {{"mean", stored.mean},           {"deviation", stored.deviation},
                {"pixels", std::sqrt(p.pixels)}, {"rows", std::sqrt(p.rows)},
                {"columns", std::sqrt(p.cols)},  {"outliers", p.outliers}};
    };
    const ChipCalibration& c = estimate.calibration;
    return {{"rows", c.shape.rows},
            {"cols", c.shape.cols},
            {"planes", c.shape.planes},
            {"flats", c.flats},
            {"darks", c.darks},
            {"gain", map(figures.gain, estimate.gain)},
            {"gain_error", figures.gain_error},
            {"offset_dn", map(figures.offset_dn, estimate.offset_dn)},
            {"dark_dn_per_s", map(figures.dark_dn_per_s, estimate.dark_dn_per_s)},
            {"readout_noise_dn2", map(figures.readout_noise_dn2, estimate.readout_noise_dn2)},
            {"response", json_of(estimate.response)},
            {"defects", figures.defects}};
}

std::string text_of(const std::string& file, const ChipEstimate& estimate,
                    const ChipFigures& figures) {
    const ChipCalibration& c = estimate.calibration;
    return fmt::format(
        "{}: {} x {} pixels from {} and {} of each\n"
        "  gain          1 +- {}, uncertainty {}\n"
        "  offset        {} +- {} DN\n"
        "  dark current  {} +- {} DN/s\n"
        "  readout noise {} DN\n"
        "  response      {}\n"
        "  defects       {}",
        file, c.shape.cols, c.shape.rows, counted(c.flats, "flat"), counted(c.darks, "dark"),
        rounded(figures.gain.deviation), rounded(figures.gain_error),
        rounded(figures.offset_dn.mean), rounded(figures.offset_dn.deviation),
        rounded(figures.dark_dn_per_s.mean), rounded(figures.dark_dn_per_s.deviation),
        rounded(std::sqrt(figures.readout_noise_dn2.mean)), text_of(estimate.response),
        figures.defects);
}

void write(PendingOutput& output, const ChipCalibration& calibration) {
    const auto bytes = encode_chip_calibration(calibration);
    write_text(output, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// The gains from a stream of any scene.
void write_scene_gains(const CalibrateOptions& options, const RunOptions& run, JsonFile& json,
                       PendingOutput& output) {
    const ChipCalibration calibration = calibrate_by_scene(options.scene, run);
    write(output, calibration);
    const FrameShape shape = calibration.shape;
    const MapFigures gain = chip_figures(calibration).gain;
    json.write({{"rows", shape.rows},
                {"cols", shape.cols},
                {"planes", shape.planes},
                {"gain", {{"mean", gain.mean}, {"deviation", gain.deviation}}}});
    run.say(fmt::format("{}: {} x {} pixels from the scene of {}\n  gain          1 +- {}",
                        options.output, shape.cols, shape.rows, options.scene.stream,
                        rounded(gain.deviation)));
}

void calibrate(const CalibrateOptions& options, const RunOptions& run) {
    JsonFile json(run);
    PendingOutput output(options.output, run.force);
    say_leftover(options.output);
    if (!options.scene.stream.empty()) return write_scene_gains(options, run, json, output);
    const ChipEstimate estimate =
        estimate_series(read_fields(options.series, run), !options.no_dark_current);
    write(output, estimate.calibration);
    const ChipFigures figures = chip_figures(estimate.calibration);
    json.write(json_of(estimate, figures));
    run.say(text_of(options.output, estimate, figures));
}

/// One source of samples, and what belongs to it.
void check_sources(const Command& command, const CalibrateOptions& options) {
    const SeriesArguments& series = options.series;
    const int sources = (series.sensor.sensor.empty() ? 0 : 1) + (series.images.empty() ? 0 : 1) +
                        (series.dark.empty() && series.flat.empty() ? 0 : 1) +
                        (options.scene.stream.empty() ? 0 : 1);
    if (sources != 1)
        throw UsageError("--sensor",
                         "one of --sensor, --series, --scene, and --dark with --flat is needed");
    if (options.scene.stream.empty())
        command.refuse({"--method", "--prnu"}, "is of --scene; add that or leave this out");
    else
        command.refuse({"--no-dark-current"}, "is of series without light; leave it out");
    check_series(command, series);
}

}  // namespace

void add_calibrate(Command& app, Action& action) {
    Command command = app.add_command(
        "calibrate", "Gain, offset, dark current, response curve and defects of a chip");
    const auto options = std::make_shared<CalibrateOptions>();
    add_series_arguments(command, options->series);
    add_scene_arguments(command, options->scene);
    command.add_flag("--no-dark-current", options->no_dark_current,
                     "take the dark current for 0: one exposure time without light is enough");
    add_output(command, options->output, "calibration, for \"stipple decode\"");
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple calibrate --sensor t6 --size 128x128 -o t6.stcal\n"
        "  stipple calibrate --dark dark.stipple --flat flat.stipple -o chip.stcal\n"
        "  stipple calibrate --series camera/emva1288_data.txt -o camera.stcal\n"
        "  stipple calibrate --scene clip.stipple -o clip.stcal\n"
        "  stipple decode clip.stipple -o decoded --calibration t6.stcal");
    set_action(command, action, options, calibrate,
               [command, options] { check_sources(command, *options); });
}

}  // namespace stipple
