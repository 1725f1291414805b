#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/arguments/checks.h"
#include "apps/arguments/settings.h"
#include "apps/calibrate_scene.h"
#include "apps/interrupt.h"
#include "apps/report/json_file.h"
#include "apps/report/leftovers.h"
#include "apps/report/number_text.h"
#include "apps/report/progress.h"
#include "apps/report/text_file.h"
#include "apps/standard_error.h"
#include "apps/subcommands.h"
#include "calibration/calibration_file.h"
#include "calibration/chip_estimate.h"
#include "core/error.h"
#include "core/input_file.h"
#include "core/memory_limit.h"
#include "io/dn_image.h"
#include "metrics/emva1288/series_evaluation.h"
#include "readout/flat_field.h"
#include "readout/provenance.h"
#include "readout/sensor_file.h"
#include "stream/stream_figures.h"
#include "stream/stream_reader.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

struct CalibrateOptions {
    SensorChoice sensor = {.sensor = ""};
    FrameShape shape{.rows = 0, .cols = 0, .planes = 1};
    CalibrationImages images;
    std::string series;  ///< descriptor of images
    std::vector<std::string> dark;
    std::vector<std::string> flat;
    bool no_dark_current = false;
    SceneArguments scene;
    std::string output;
};

/// The samples for a calibration, and of which chip they are.
struct Fields {
    StreamHeader header;
    FieldSamples dark;
    FieldSamples flat;
    std::string dark_name;
    std::string flat_name;
    ChipIdentity chip = {};
    bool well_known = true;
};

/// Sums of the samples and maps of an array: 20 bytes a site for each exposure time, 160 for maps.
void require_memory(FrameShape shape, std::string_view where) {
    constexpr std::uint64_t kSiteBytes = 256;
    check_memory(shape.sites() * kSiteBytes, where,
                 fmt::format("the calibration of {} x {} pixels", shape.cols, shape.rows));
}

Fields emulate_series(const CalibrateOptions& options, const RunOptions& run) {
    require_memory(options.shape, "--size");
    const SensorParams params = set_up_params(options.sensor);
    const auto exposures = calibration_exposures(params, options.images, options.sensor.seed);
    const std::string where = fmt::format("sensor \"{}\"", options.sensor.sensor);
    Fields fields{.header = FlatField(params, 0, options.shape).header(),
                  .dark = FieldSamples(options.shape),
                  .flat = FieldSamples(options.shape),
                  .dark_name = where,
                  .flat_name = where};
    if (params.name.size() <= kMaxNameBytes) fields.chip.name = params.name;
    if (params.mode == SensorMode::kPhysical) fields.chip.device_id = params.physical.device_id;
    int images = 0;
    for (const CalibrationExposure& exposure : exposures) images += exposure.images;
    Progress progress(run, "exposing", images);
    for (const CalibrationExposure& exposure : exposures) {
        SensorParams timed = params;
        timed.slot_us = exposure.slot_us;
        FlatField field(timed, exposure.seed, options.shape);
        FieldCollector collector(field.header(), exposure.photons > 0 ? fields.flat : fields.dark);
        for (int i = 0; i < exposure.images; ++i) {
            throw_if_stopped();
            collector.add(field.expose(exposure.photons));
            progress.advance();
        }
    }
    return fields;
}

/// The header of images of one exposure time, whose gain and full well are unknown.
StreamHeader header_of(const emva1288::Series& series, double exposure_ns) {
    return {.shape = {.rows = series.rows, .cols = series.cols, .planes = 1},
            .slot_us = exposure_ns / 1000,
            .calibration = {.bit_depth = series.bits,
                            .gain_e_per_dn = 1,
                            .read_noise_e = 0,
                            .full_well_e = 1e12,
                            .electrons_per_unit = 1},
            .schedule = {1, 1, 1, {0, 1}, {{.first_slot = 0, .open_slots = 1}}},
            .schedule_source = {},
            .schedule_name = "",
            .provenance = ""};
}

/// The dark groups of a series, and the bright group that has the most images.
Fields read_series(const CalibrateOptions& options, const RunOptions& run) {
    const auto bytes = read_file(options.series);
    const emva1288::Series series = emva1288::parse_series(
        {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, options.series);
    require_memory({.rows = series.rows, .cols = series.cols}, options.series);
    Fields fields{.header = header_of(series, 0),
                  .dark = FieldSamples(header_of(series, 0).shape),
                  .flat = FieldSamples(header_of(series, 0).shape),
                  .dark_name = options.series,
                  .flat_name = options.series,
                  .well_known = false};
    const emva1288::ImageGroup* flats = nullptr;
    for (const emva1288::ImageGroup& group : series.groups)
        if (!group.dark && (flats == nullptr || group.files.size() > flats->files.size()))
            flats = &group;
    Progress progress(run, "reading", {});
    for (const emva1288::ImageGroup& group : series.groups) {
        if (!group.dark && &group != flats) continue;
        const StreamHeader header = header_of(series, group.exposure_ns);
        FieldCollector collector(header, group.dark ? fields.dark : fields.flat);
        for (const std::string& name : group.files) {
            throw_if_stopped();
            const fs::path file = fs::path(options.series).parent_path() / name;
            DnImage image = read_dn_image(file);
            emva1288::SeriesImage dn{image.shape.rows, image.shape.cols, std::move(image.dn)};
            emva1288::require_image_of(series, dn, file.string());
            collector.add({.rows = dn.rows, .dn = std::move(dn.dn)});
            progress.advance();
        }
    }
    return fields;
}

/// Adds the samples of streams of one chip.
void add_streams(const std::vector<std::string>& files, const StreamHeader& chip,
                 FieldSamples& field, Progress& progress) {
    for (const std::string& file : files) {
        StreamReader reader(file);
        const StreamHeader& header = reader.header();
        if (header.shape != chip.shape || header.cfa != chip.cfa ||
            header.calibration != chip.calibration)
            throw InputError(file,
                             "is of another sensor than the first stream; give streams of "
                             "one chip with the same settings");
        FieldCollector collector(header, field);
        for (SamplePacket packet; reader.next(packet);) {
            throw_if_stopped();
            collector.add(packet);
            progress.advance();
        }
        if (!undamaged(reader.report()))
            say_warning(fmt::format("{}: {}", file, damage_text(reader.report())));
    }
}

Fields read_streams(const CalibrateOptions& options, const RunOptions& run) {
    const StreamReader first(options.dark.front());
    const StreamHeader& header = first.header();
    require_memory(header.shape, options.dark.front());
    Fields fields{.header = header,
                  .dark = FieldSamples(header.shape),
                  .flat = FieldSamples(header.shape),
                  .dark_name = options.dark.front(),
                  .flat_name = options.flat.front()};
    const ChipOrigin chip = chip_of(header.provenance);
    if (chip.name.size() <= kMaxNameBytes) fields.chip.name = chip.name;
    fields.chip.device_id = chip.device_id;
    Progress progress(run, "reading", {});
    add_streams(options.dark, header, fields.dark, progress);
    add_streams(options.flat, header, fields.flat, progress);
    return fields;
}

nlohmann::ordered_json json_of(const ChipEstimate& estimate, double gain_error) {
    const auto pattern = [](const PatternVariances& p) -> nlohmann::ordered_json {
        return {{"mean", p.mean},
                {"pixels", std::sqrt(p.pixels)},
                {"rows", std::sqrt(p.rows)},
                {"columns", std::sqrt(p.cols)},
                {"outliers", p.outliers}};
    };
    const ChipCalibration& c = estimate.calibration;
    return {{"rows", c.shape.rows},
            {"cols", c.shape.cols},
            {"planes", c.shape.planes},
            {"flats", c.flats},
            {"darks", c.darks},
            {"gain", pattern(estimate.gain)},
            {"gain_error", gain_error},
            {"offset_dn", pattern(estimate.offset_dn)},
            {"dark_dn_per_s", pattern(estimate.dark_dn_per_s)},
            {"readout_noise_dn2", pattern(estimate.readout_noise_dn2)},
            {"defects", estimate.defects}};
}

/// Root mean square of the standard deviations of the gains.
double gain_error_of(const ChipCalibration& calibration) {
    double sum = 0;
    for (const SiteCalibration& site : calibration.sites)
        sum += static_cast<double>(site.gain_variance);
    return std::sqrt(sum / static_cast<double>(calibration.sites.size()));
}

std::string text_of(const std::string& file, const ChipEstimate& estimate, double gain_error) {
    const auto deviation = [](const PatternVariances& p) {
        return rounded(std::sqrt(p.pixels + p.rows + p.cols));
    };
    const ChipCalibration& c = estimate.calibration;
    return fmt::format(
        "{}: {} x {} pixels from {} and {} of each\n"
        "  gain          1 +- {}, known to {}\n"
        "  offset        {} +- {} DN\n"
        "  dark current  {} +- {} DN/s\n"
        "  readout noise {} DN\n"
        "  defects       {}",
        file, c.shape.cols, c.shape.rows, counted(c.flats, "flat"), counted(c.darks, "dark"),
        deviation(estimate.gain), rounded(gain_error), rounded(estimate.offset_dn.mean),
        deviation(estimate.offset_dn), rounded(estimate.dark_dn_per_s.mean),
        deviation(estimate.dark_dn_per_s),
        rounded(std::sqrt(std::max(estimate.readout_noise_dn2.mean, 0.0))), estimate.defects);
}

void write(PendingOutput& output, const ChipCalibration& calibration) {
    const auto bytes = encode_chip_calibration(calibration);
    write_text(output, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// Root mean square distance of the gains to 1.
double gain_spread_of(const ChipCalibration& calibration) {
    double sum = 0;
    for (const SiteCalibration& site : calibration.sites)
        sum += std::pow(static_cast<double>(site.gain) - 1, 2);
    return std::sqrt(sum / static_cast<double>(calibration.sites.size()));
}

/// The gains from a stream of any scene.
void write_scene_gains(const CalibrateOptions& options, const RunOptions& run, JsonFile& json,
                       PendingOutput& output) {
    const ChipCalibration calibration = calibrate_by_scene(options.scene, run);
    write(output, calibration);
    const FrameShape shape = calibration.shape;
    const double spread = gain_spread_of(calibration);
    json.write({{"rows", shape.rows},
                {"cols", shape.cols},
                {"planes", shape.planes},
                {"gain", {{"mean", 1}, {"pixels", spread}}}});
    run.say(fmt::format("{}: {} x {} pixels from the scene of {}\n  gain          1 +- {}",
                        options.output, shape.cols, shape.rows, options.scene.stream,
                        rounded(spread)));
}

void calibrate(const CalibrateOptions& options, const RunOptions& run) {
    JsonFile json(run);
    PendingOutput output(options.output, run.force);
    say_leftover(options.output);
    if (!options.scene.stream.empty()) return write_scene_gains(options, run, json, output);
    const Fields fields = !options.series.empty() ? read_series(options, run)
                          : !options.dark.empty() ? read_streams(options, run)
                                                  : emulate_series(options, run);
    ChipEstimate estimate = estimate_chip({.header = fields.header,
                                           .dark = fields.dark,
                                           .flat = fields.flat,
                                           .dark_name = fields.dark_name,
                                           .flat_name = fields.flat_name,
                                           .well_known = fields.well_known,
                                           .dark_current = !options.no_dark_current});
    estimate.calibration.chip = fields.chip;
    write(output, estimate.calibration);
    const double gain_error = gain_error_of(estimate.calibration);
    json.write(json_of(estimate, gain_error));
    run.say(text_of(options.output, estimate, gain_error));
}

/// One source of samples, and what belongs to it.
void check_sources(const Command& command, const CalibrateOptions& options) {
    const int sources = (options.sensor.sensor.empty() ? 0 : 1) + (options.series.empty() ? 0 : 1) +
                        (options.dark.empty() && options.flat.empty() ? 0 : 1) +
                        (options.scene.stream.empty() ? 0 : 1);
    if (sources != 1)
        throw UsageError("--sensor",
                         "one of --sensor, --series, --scene, and --dark with --flat is needed");
    if (options.scene.stream.empty())
        command.refuse({"--method", "--prnu"}, "is of --scene; add that or leave this out");
    else
        command.refuse({"--no-dark-current"}, "is of series without light; leave it out");
    if (options.dark.empty() != options.flat.empty())
        throw UsageError(options.dark.empty() ? "--dark" : "--flat",
                         "streams without light and of uniform light are both needed");
    if (options.sensor.sensor.empty())
        command.refuse({"--set", "--size", "--planes", "--flats", "--darks", "--seed"},
                       "is of --sensor; add that or leave this out");
    else if (options.shape.pixels() == 0)
        throw UsageError("--size", "width and height of the array are needed, as of the footage");
}

void add_sources(Command& command, CalibrateOptions& options) {
    command
        .add_option("--sensor", options.sensor.sensor,
                    "emulate the series of a sensor, of \"stipple list sensors\"")
        .type_name("NAME|FILE")
        .listed("sensors")
        .input();
    add_settings(command, {{"sensor", &options.sensor.settings}}, "change a key of the sensor");
    add_size(command, "--size", options.shape, {1, kMaxFrameSide},
             "with --sensor: width and height of its array");
    command
        .add_option("--planes", options.shape.planes,
                    "with --sensor: 1 mono or mosaic, 3 stacked red, green and blue")
        .shows_default()
        .check(whole_check(1, 4))
        .type_name("N");
    command.add_option("--flats", options.images.flats, "with --sensor: images of uniform light")
        .shows_default()
        .check(whole_check(1, 65535))
        .type_name("N");
    command
        .add_option("--darks", options.images.darks,
                    "with --sensor: images without light, of each of two exposure times")
        .shows_default()
        .check(whole_check(1, 65535))
        .type_name("N");
    command.add_option("--seed", options.sensor.seed, "with --sensor: seed of the noise")
        .shows_default()
        .check(whole_check(0))
        .type_name("S");
    command
        .add_option("--series", options.series,
                    "images of a camera: their descriptor (docs/characterize.md)")
        .type_name("FILE")
        .input();
    command.add_list("--dark", options.dark, "stream of the chip without light; may be repeated")
        .type_name("STREAM")
        .input();
    command.add_list("--flat", options.flat, "stream of the chip in uniform light; may be repeated")
        .type_name("STREAM")
        .input();
}

}  // namespace

void add_calibrate(Command& app, Action& action) {
    Command command =
        app.add_command("calibrate", "Gain, offset, dark current and defects of each pixel");
    const auto options = std::make_shared<CalibrateOptions>();
    add_sources(command, *options);
    add_scene_arguments(command, options->scene);
    command.add_flag("--no-dark-current", options->no_dark_current,
                     "take the dark current for 0: one exposure time without light is enough");
    command.add_option("-o,--output", options->output, "calibration, for \"stipple decode\"")
        .type_name("FILE")
        .required()
        .output();
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
