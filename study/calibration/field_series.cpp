#include "study/calibration/field_series.h"

#include <fmt/format.h>

#include <utility>

#include "calibration/chip_exposures.h"
#include "core/error.h"
#include "core/index.h"
#include "core/input_file.h"
#include "core/memory_limit.h"
#include "io/image_file.h"
#include "readout/provenance.h"
#include "stream/stream_figures.h"
#include "stream/stream_reader.h"
#include "study/metrics/emva1288/series_evaluation.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

using emva1288::ImageGroup;
using emva1288::Series;

/// Sums of the samples of some exposure times, and maps of an array.
void require_memory(FrameShape shape, std::size_t times, std::string_view where) {
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
    ImageSeries(const fs::path& descriptor, const SeriesObserver& observer)
        : descriptor_(descriptor), observer_(observer) {
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
            observer_.advance();
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
    const SeriesObserver& observer_;
    Series series_;
};

/// Adds the samples of a stream of a chip.
void add_stream(const fs::path& file, FieldSeries& fields, FieldSamples& field,
                const SeriesObserver& observer) {
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
        observer.advance();
    }
    if (!undamaged(reader.report()))
        observer.warn(fmt::format("{}: {}", file.string(), damage_text(reader.report())));
}

}  // namespace

int default_levels(const SensorParams& params) {
    constexpr int kLevels = 12;
    const PhysicalTerms& terms = params.physical;
    return terms.response_loss != 0 || terms.inl_dn != 0 ? kLevels : 0;
}

FieldSeries expose_series(const EmulatedSeries& series,
                          const std::vector<CalibrationExposure>& exposures,
                          const SeriesObserver& observer) {
    const SensorParams& params = series.params;
    require_memory(series.shape, exposures.size(), series.size_where);
    const std::string where = fmt::format("sensor \"{}\"", series.sensor);
    FieldSeries fields{.header = FlatField(params, 0, series.shape).header(),
                       .dark = FieldSamples(series.shape),
                       .flats = {FieldSamples(series.shape)},
                       .dark_name = where,
                       .flat_name = where};
    if (params.name.size() <= kMaxNameBytes) fields.chip.name = params.name;
    if (params.mode == SensorMode::kPhysical) fields.chip.device_id = params.physical.device_id;
    for (const CalibrationExposure& exposure : exposures) {
        SensorParams timed = params;
        timed.slot_us = exposure.slot_us;
        FlatField field(timed, exposure.seed, series.shape);
        FieldCollector collector(field.header(),
                                 exposure.photons > 0 ? fields.flats.front() : fields.dark);
        for (int i = 0; i < exposure.images; ++i) {
            collector.add(field.expose(exposure.photons));
            observer.advance();
        }
    }
    return fields;
}

FieldSeries read_image_series(const fs::path& descriptor, const SeriesObserver& observer) {
    return ImageSeries(descriptor, observer).read();
}

FieldSeries read_field_streams(const std::vector<fs::path>& dark, const std::vector<fs::path>& flat,
                               const SeriesObserver& observer) {
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
    for (const fs::path& file : dark) add_stream(file, fields, fields.dark, observer);
    for (const fs::path& file : flat) {
        fields.flats.emplace_back(header.shape);
        add_stream(file, fields, fields.flats.back(), observer);
        require_samples({&fields.flats.back(), 1}, file.string());
    }
    return fields;
}

ChipEstimate estimate_series(const FieldSeries& series, bool dark_current) {
    ChipEstimate estimate = estimate_chip({.header = series.header,
                                           .dark = series.dark,
                                           .flats = series.flats,
                                           .levels = series.levels,
                                           .dark_name = series.dark_name,
                                           .flat_name = series.flat_name,
                                           .well_known = series.well_known,
                                           .dark_current = dark_current});
    estimate.calibration.chip = series.chip;
    return estimate;
}

}  // namespace stipple
