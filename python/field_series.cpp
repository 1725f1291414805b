#include "python/field_series.h"

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <utility>

#include "calibration/chip_exposures.h"
#include "core/error.h"
#include "core/input_file.h"
#include "core/memory_limit.h"
#include "io/image_file.h"
#include "python/errors.h"
#include "readout/provenance.h"
#include "stream/stream_figures.h"
#include "stream/stream_reader.h"
#include "study/metrics/emva1288/series_evaluation.h"

namespace stipple::python {
namespace py = pybind11;
namespace fs = std::filesystem;
namespace {

using emva1288::ImageGroup;
using emva1288::Series;

/// Sums of the samples of some exposure times, and maps of an array.
void require_memory(FrameShape shape, std::size_t times, const std::string& where) {
    constexpr std::uint64_t kMapBytes = 160, kTimeBytes = 20;  // of a site
    check_memory(shape.sites() * (kMapBytes + times * kTimeBytes), where,
                 fmt::format("the calibration of {} x {} pixels", shape.cols, shape.rows));
}

/// The header of images of one exposure time, whose gain and full well are unknown.
StreamHeader header_of(const Series& series, double exposure_ns) {
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

/// Images of a camera that a descriptor lists.
class ImageSeries {
  public:
    ImageSeries(const fs::path& descriptor, CallProgress& progress)
        : descriptor_(descriptor), progress_(progress) {
        const auto bytes = read_file(descriptor);
        series_ = emva1288::parse_series(
            {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, descriptor.string());
    }

    FieldSeries read() {
        const StreamHeader header = header_of(series_, 0);
        const std::string name = descriptor_.string();
        require_memory(header.shape, 4, name);
        FieldSeries fields{.header = header,
                           .dark = FieldSamples(header.shape),
                           .flats = {FieldSamples(header.shape)},
                           .dark_name = name,
                           .flat_name = name,
                           .well_known = false};
        const ImageGroup* flats = nullptr;
        for (const ImageGroup& group : series_.groups)
            if (!group.dark && (flats == nullptr || group.files.size() > flats->files.size()))
                flats = &group;
        for (const ImageGroup& group : series_.groups)
            if (group.dark || &group == flats)
                add(group, group.dark ? fields.dark : fields.flats.front());
        add_levels(fields);
        return fields;
    }

  private:
    void add(const ImageGroup& group, FieldSamples& field) {
        const StreamHeader header = header_of(series_, group.exposure_ns);
        FieldCollector collector(header, field);
        for (const std::string& name : group.files) {
            const fs::path file = descriptor_.parent_path() / name;
            DnImage image = read_dn_image(file);
            emva1288::SeriesImage dn{image.shape.rows, image.shape.cols, std::move(image.dn)};
            emva1288::require_image_of(series_, dn, file.string());
            collector.add({.rows = dn.rows, .dn = std::move(dn.dn)});
            if (!progress_.reach(++done_)) throw CalibrationEnded{};
        }
    }

    /// The exposures of a field that do not reach full scale.
    static std::vector<FieldExposure> exposures_of(const StreamHeader& header,
                                                   const FieldSamples& field) {
        constexpr double kMaxSaturated = 0.01;
        std::vector<FieldExposure> exposures;
        for (const auto& [time, sums] : field.exposures())
            if (static_cast<double>(sums.saturated) <=
                kMaxSaturated * static_cast<double>(sums.samples))
                exposures.push_back(field_exposure(time, sums, header));
        return exposures;
    }

    /// Of all bright groups; photons tell their ratios.
    void add_levels(FieldSeries& fields) {
        const std::vector<FieldExposure> dark = exposures_of(fields.header, fields.dark);
        if (dark.empty()) return;
        for (const ImageGroup& group : series_.groups) {
            if (group.dark || group.files.size() < 2 || !(group.photons > 0)) continue;
            FieldSamples field(fields.header.shape);
            add(group, field);
            const auto more =
                response_levels(fields.header, dark, exposures_of(fields.header, field),
                                {.light_per_s = group.photons / group.exposure_ns});
            fields.levels.insert(fields.levels.end(), more.begin(), more.end());
        }
        leave_out_clipped(fields.levels);
    }

    fs::path descriptor_;
    CallProgress& progress_;
    Series series_;
    double done_ = 0;
};

/// Adds the samples of a stream of a chip.
void add_stream(const fs::path& file, FieldSeries& fields, FieldSamples& field,
                CallProgress& progress) {
    StreamReader reader(file);
    const StreamHeader& header = reader.header();
    if (header.shape != fields.header.shape || header.cfa != fields.header.cfa ||
        header.calibration != fields.header.calibration)
        throw InputError(file.string(),
                         "is of another sensor than the first stream; give streams of "
                         "one chip with the same settings");
    FieldCollector collector(header, field);
    for (SamplePacket packet; reader.next(packet);) {
        collector.add(packet);
        if (!progress.reach(0)) throw CalibrationEnded{};
    }
    if (!undamaged(reader.report()))
        fields.warnings.emplace_back(
            fmt::format("{}: {}", file.string(), damage_text(reader.report())));
}

}  // namespace

EmulatedSeries emulated_series(const py::object& sensor, const py::dict& numbers) {
    const auto take = [&](const char* name, std::uint64_t min, std::uint64_t max) {
        const std::uint64_t number = whole_in(numbers[name], name);
        if (number < min || number > max)
            throw InputError(name, fmt::format("{} is outside {}..{}", number, min, max));
        return static_cast<int>(number);
    };
    EmulatedSeries series{.sensor = sensor_of(sensor), .shape = {}, .images = {}};
    const auto [rows, cols] = size_in(numbers["size"], "size");
    if (rows < 1 || cols < 1 || rows > kMaxFrameSide || cols > kMaxFrameSide)
        throw InputError(
            "size", fmt::format("({}, {}) is outside 1..{}, for both", rows, cols, kMaxFrameSide));
    series.shape = {.rows = static_cast<int>(rows),
                    .cols = static_cast<int>(cols),
                    .planes = take("planes", 1, 4)};
    series.images.flats = take("flats", 1, 65535);
    series.images.darks = take("darks", 1, 65535);
    const PhysicalTerms& terms = series.sensor.description.params.physical;
    if (!numbers["levels"].is_none())
        series.images.levels = take("levels", 0, 1000);
    else if (terms.response_loss != 0 || terms.inl_dn != 0)
        series.images.levels = 12;
    series.seed = whole_in(numbers["seed"], "seed");
    return series;
}

FieldSeries expose_series(const EmulatedSeries& series,
                          const std::vector<CalibrationExposure>& exposures,
                          CallProgress& progress) {
    const SensorParams& params = series.sensor.description.params;
    require_memory(series.shape, 3 + static_cast<std::size_t>(series.images.levels), "size");
    const std::string where = fmt::format("sensor \"{}\"", series.sensor.choice.sensor);
    FieldSeries fields{.header = FlatField(params, 0, series.shape).header(),
                       .dark = FieldSamples(series.shape),
                       .flats = {FieldSamples(series.shape)},
                       .dark_name = where,
                       .flat_name = where};
    if (params.name.size() <= kMaxNameBytes) fields.chip.name = params.name;
    if (params.mode == SensorMode::kPhysical) fields.chip.device_id = params.physical.device_id;
    double done = 0;
    for (const CalibrationExposure& exposure : exposures) {
        SensorParams timed = params;
        timed.slot_us = exposure.slot_us;
        FlatField field(timed, exposure.seed, series.shape);
        FieldCollector collector(field.header(),
                                 exposure.photons > 0 ? fields.flats.front() : fields.dark);
        for (int i = 0; i < exposure.images; ++i) {
            collector.add(field.expose(exposure.photons));
            if (!progress.reach(++done)) throw CalibrationEnded{};
        }
    }
    return fields;
}

FieldSeries read_image_series(const fs::path& descriptor, CallProgress& progress) {
    return ImageSeries(descriptor, progress).read();
}

FieldSeries read_field_streams(const std::vector<fs::path>& dark, const std::vector<fs::path>& flat,
                               CallProgress& progress) {
    const StreamReader first(dark.front());
    const StreamHeader& header = first.header();
    require_memory(header.shape, 4 * (1 + flat.size()), dark.front().string());
    FieldSeries fields{.header = header,
                       .dark = FieldSamples(header.shape),
                       .flats = {},
                       .dark_name = dark.front().string(),
                       .flat_name = flat.front().string()};
    const ChipOrigin chip = chip_of(header.provenance);
    if (chip.name.size() <= kMaxNameBytes) fields.chip.name = chip.name;
    fields.chip.device_id = chip.device_id;
    for (const fs::path& file : dark) add_stream(file, fields, fields.dark, progress);
    for (const fs::path& file : flat) {
        fields.flats.emplace_back(header.shape);
        add_stream(file, fields, fields.flats.back(), progress);
        require_samples({&fields.flats.back(), 1}, file.string());
    }
    return fields;
}

}  // namespace stipple::python
