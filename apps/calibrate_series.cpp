#include "apps/calibrate.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <utility>

#include "apps/arguments/common_options.h"
#include "apps/arguments/settings.h"
#include "apps/interrupt.h"
#include "apps/output/progress.h"
#include "apps/standard_streams.h"
#include "calibration/chip_exposures.h"
#include "calibration/field_samples.h"
#include "core/error.h"
#include "core/index.h"
#include "core/input_file.h"
#include "core/memory_limit.h"
#include "io/image_file.h"
#include "readout/provenance.h"
#include "readout/sensor_file.h"
#include "stream/stream_figures.h"
#include "stream/stream_reader.h"
#include "study/metrics/emva1288/series_evaluation.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

/// Sums of the samples of some exposure times, and maps of an array.
void require_memory(FrameShape shape, std::size_t times, std::string_view where) {
    constexpr std::uint64_t kMapBytes = 160, kTimeBytes = 20;  // of a site
    check_memory(shape.sites() * (kMapBytes + times * kTimeBytes), where,
                 fmt::format("the calibration of {} x {} pixels", shape.cols, shape.rows));
}

int default_levels(const SensorParams& params) {
    constexpr int kLevels = 12;
    const PhysicalTerms& terms = params.physical;
    return terms.response_loss != 0 || terms.inl_dn != 0 ? kLevels : 0;
}

CalibrationFields emulate_series(const SeriesArguments& arguments, const RunOptions& run) {
    const SensorParams params = set_up_params(arguments.sensor);
    CalibrationImages images = arguments.emulated;
    images.levels = arguments.levels >= 0 ? arguments.levels : default_levels(params);
    require_memory(arguments.shape, 3 + index(images.levels), "--size");
    const auto exposures = calibration_exposures(params, images, arguments.sensor.seed);
    const std::string where = fmt::format("sensor \"{}\"", arguments.sensor.sensor);
    CalibrationFields fields{.header = FlatField(params, 0, arguments.shape).header(),
                             .dark = FieldSamples(arguments.shape),
                             .flats = {FieldSamples(arguments.shape)},
                             .dark_name = where,
                             .flat_name = where};
    if (params.name.size() <= kMaxNameBytes) fields.chip.name = params.name;
    if (params.mode == SensorMode::kPhysical) fields.chip.device_id = params.physical.device_id;
    int count = 0;
    for (const CalibrationExposure& exposure : exposures) count += exposure.images;
    Progress progress(run, "exposing", count);
    for (const CalibrationExposure& exposure : exposures) {
        SensorParams timed = params;
        timed.slot_us = exposure.slot_us;
        FlatField field(timed, exposure.seed, arguments.shape);
        FieldCollector collector(field.header(),
                                 exposure.photons > 0 ? fields.flats.front() : fields.dark);
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

void add_images(const emva1288::Series& series, const emva1288::ImageGroup& group,
                const std::string& descriptor, FieldSamples& field, Progress& progress) {
    const StreamHeader header = header_of(series, group.exposure_ns);
    FieldCollector collector(header, field);
    for (const std::string& name : group.files) {
        throw_if_stopped();
        const fs::path file = fs::path(descriptor).parent_path() / name;
        DnImage image = read_dn_image(file);
        emva1288::SeriesImage dn{image.shape.rows, image.shape.cols, std::move(image.dn)};
        emva1288::require_image_of(series, dn, file.string());
        collector.add({.rows = dn.rows, .dn = std::move(dn.dn)});
        progress.advance();
    }
}

/// The exposures of a field that do not reach full scale.
std::vector<FieldExposure> exposures_of(const StreamHeader& header, const FieldSamples& field) {
    constexpr double kMaxSaturated = 0.01;
    std::vector<FieldExposure> exposures;
    for (const auto& [time, sums] : field.exposures())
        if (static_cast<double>(sums.saturated) <=
            kMaxSaturated * static_cast<double>(sums.samples))
            exposures.push_back(field_exposure(time, sums, header));
    return exposures;
}

/// The levels of all bright groups; photons tell their ratios.
std::vector<ResponseLevel> levels_of(const emva1288::Series& series, const std::string& descriptor,
                                     const CalibrationFields& fields, Progress& progress) {
    const std::vector<FieldExposure> dark = exposures_of(fields.header, fields.dark);
    std::vector<ResponseLevel> levels;
    if (dark.empty()) return levels;
    for (const emva1288::ImageGroup& group : series.groups) {
        if (group.dark || group.files.size() < 2 || !(group.photons > 0)) continue;
        FieldSamples field(fields.header.shape);
        add_images(series, group, descriptor, field, progress);
        const auto more = response_levels(fields.header, dark, exposures_of(fields.header, field),
                                          {.light_per_s = group.photons / group.exposure_ns});
        levels.insert(levels.end(), more.begin(), more.end());
    }
    leave_out_clipped(levels);
    return levels;
}

/// The dark groups of a series, and the bright group that has the most images.
CalibrationFields read_images(const SeriesArguments& arguments, const RunOptions& run) {
    const std::string& descriptor = arguments.images;
    const auto bytes = read_file(descriptor);
    const emva1288::Series series = emva1288::parse_series(
        {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, descriptor);
    const StreamHeader header = header_of(series, 0);
    require_memory(header.shape, 4, descriptor);
    CalibrationFields fields{.header = header,
                             .dark = FieldSamples(header.shape),
                             .flats = {FieldSamples(header.shape)},
                             .dark_name = descriptor,
                             .flat_name = descriptor,
                             .well_known = false};
    const emva1288::ImageGroup* flats = nullptr;
    for (const emva1288::ImageGroup& group : series.groups)
        if (!group.dark && (flats == nullptr || group.files.size() > flats->files.size()))
            flats = &group;
    Progress progress(run, "reading", {});
    for (const emva1288::ImageGroup& group : series.groups)
        if (group.dark || &group == flats)
            add_images(series, group, descriptor, group.dark ? fields.dark : fields.flats.front(),
                       progress);
    fields.levels = levels_of(series, descriptor, fields, progress);
    return fields;
}

/// Adds the samples of a stream of a chip.
void add_stream(const std::string& file, const StreamHeader& chip, FieldSamples& field,
                Progress& progress) {
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
    if (!undamaged(reader.report())) say_warning("{}: {}", file, damage_text(reader.report()));
}

CalibrationFields read_streams(const SeriesArguments& arguments, const RunOptions& run) {
    const StreamReader first(arguments.dark.front());
    const StreamHeader& header = first.header();
    require_memory(header.shape, 4 * (1 + arguments.flat.size()), arguments.dark.front());
    CalibrationFields fields{.header = header,
                             .dark = FieldSamples(header.shape),
                             .flats = {},
                             .dark_name = arguments.dark.front(),
                             .flat_name = arguments.flat.front()};
    const ChipOrigin chip = chip_of(header.provenance);
    if (chip.name.size() <= kMaxNameBytes) fields.chip.name = chip.name;
    fields.chip.device_id = chip.device_id;
    Progress progress(run, "reading", {});
    for (const std::string& file : arguments.dark) add_stream(file, header, fields.dark, progress);
    for (const std::string& file : arguments.flat) {
        fields.flats.emplace_back(header.shape);
        add_stream(file, header, fields.flats.back(), progress);
        require_samples({&fields.flats.back(), 1}, file);
    }
    return fields;
}

}  // namespace

CalibrationFields read_fields(const SeriesArguments& arguments, const RunOptions& run) {
    if (!arguments.images.empty()) return read_images(arguments, run);
    return arguments.dark.empty() ? emulate_series(arguments, run) : read_streams(arguments, run);
}

void check_series(const Command& command, const SeriesArguments& arguments) {
    if (arguments.dark.empty() != arguments.flat.empty())
        throw UsageError(arguments.dark.empty() ? "--dark" : "--flat",
                         "streams without light and of uniform light are both needed");
    if (arguments.sensor.sensor.empty())
        command.refuse({"--set", "--size", "--planes", "--flats", "--darks", "--levels", "--seed"},
                       "is of --sensor; add that or leave this out");
    else if (arguments.shape.pixels() == 0)
        throw UsageError("--size", "width and height of the array are needed, as of the footage");
}

void add_series_arguments(Command& command, SeriesArguments& arguments) {
    command
        .add_option("--sensor", arguments.sensor.sensor,
                    "emulate the series of a sensor, of \"stipple list sensors\"")
        .type_name("NAME|FILE")
        .listed("sensors")
        .input();
    add_settings(command, {{"sensor", &arguments.sensor.settings}}, "change a key of the sensor");
    add_size(command, "--size", arguments.shape, {1, kMaxFrameSide},
             "with --sensor: width and height of its array");
    command
        .add_option("--planes", arguments.shape.planes,
                    "with --sensor: 1 mono or mosaic, 3 stacked red, green and blue")
        .shows_default()
        .check(whole_check(1, 4))
        .type_name("N");
    command
        .add_option("--flats", arguments.emulated.flats, "with --sensor: images of uniform light")
        .shows_default()
        .check(whole_check(1, 65535))
        .type_name("N");
    command
        .add_option("--darks", arguments.emulated.darks,
                    "with --sensor: images without light, of each of two exposure times")
        .shows_default()
        .check(whole_check(1, 65535))
        .type_name("N");
    command
        .add_option("--levels", arguments.levels,
                    "with --sensor: levels of light that tell its response curve")
        .default_text("12 of a sensor with response_loss or inl_dn, else 0")
        .check(whole_check(0, 1000))
        .type_name("N");
    add_seed(command, arguments.sensor.seed, "with --sensor: seed of the noise");
    command
        .add_option("--series", arguments.images,
                    "images of a camera: their descriptor (docs/characterize.md)")
        .type_name("FILE")
        .input();
    command.add_list("--dark", arguments.dark, "stream of the chip without light; may be repeated")
        .type_name("STREAM")
        .input();
    command
        .add_list("--flat", arguments.flat,
                  "stream of the chip in uniform, constant light; may be repeated, each with its "
                  "own light")
        .type_name("STREAM")
        .input();
}

}  // namespace stipple
