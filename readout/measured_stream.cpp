#include "readout/measured_stream.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <sstream>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "core/version.h"
#include "io/pending_output.h"
#include "readout/schedules/volume_schedule.h"
#include "stream/plain_text.h"
#include "stream/stream_writer.h"

namespace stipple {
namespace {

constexpr double kNoiseFreeElectrons = 1e6;
constexpr double kMaxWellElectrons = 1e12;
constexpr double kMinDn = 1;
constexpr double kMaxDn = 65534;

void check_sizes(const MeasuredArrays& arrays) {
    const NpyVolume& y = arrays.measurements;
    const NpyVolume& masks = arrays.masks;
    if (y.rows == masks.rows && y.cols == masks.cols) return;
    throw InputError(arrays.measurement_file,
                     fmt::format("{} measurements of {} x {} pixels (rows x columns), but the {} "
                                 "masks of {} have {} x {}; arrays are (measurements, rows, "
                                 "columns) and (slots, rows, columns)",
                                 y.layers, y.rows, y.cols, masks.layers, arrays.mask_file,
                                 masks.rows, masks.cols));
}

template <typename Visit>
void for_each_pixel(const ExposureSchedule& schedule, const Visit& visit) {
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col)
            visit(row, col, schedule.exposures(row, col));
}

struct Range {
    double min = 0;
    double max = 0;
};

/// Of 0 and the measurements of pixels with an exposure. \throws InputError.
Range range_of(const MeasuredArrays& arrays, const ExposureSchedule& schedule) {
    Range range;
    for_each_pixel(schedule, [&](int row, int col, std::span<const Exposure> exposures) {
        if (exposures.empty()) return;
        for (int m = 0; m < arrays.measurements.layers; ++m) {
            const double y = arrays.measurements.at(m, row, col);
            if (!std::isfinite(y))
                throw InputError(arrays.measurement_file,
                                 fmt::format("measurement {} pixel ({}, {}): {} is not a number", m,
                                             row, col, y));
            range = {std::min(range.min, y), std::max(range.max, y)};
        }
    });
    if (!(range.max > 0)) throw InputError(arrays.measurement_file, "no measurement is above 0");
    if (!std::isfinite(range.max - range.min))
        throw InputError(arrays.measurement_file, "measurements are too far apart");
    return range;
}

/// DN = zero_dn + dn_per_value x measurement.
struct Scale {
    double zero_dn;
    double dn_per_value;

    [[nodiscard]] std::uint16_t dn(double value) const {
        const double exact = std::round(zero_dn + dn_per_value * value);
        return static_cast<std::uint16_t>(std::clamp(exact, kMinDn, kMaxDn));
    }
};

Scale scale_of(const Range& range) {
    const double dn_per_value = (kMaxDn - kMinDn) / (range.max - range.min);
    return {.zero_dn = kMinDn - range.min * dn_per_value, .dn_per_value = dn_per_value};
}

Calibration calibration_of(const MeasuredArrays& arrays, const Scale& scale, double light) {
    Calibration c{.bit_depth = 16,
                  .black_level_dn = scale.zero_dn,
                  .read_noise_e = arrays.read_noise_e,
                  .electrons_per_unit = arrays.electrons.value_or(kNoiseFreeElectrons),
                  .noise_free = !arrays.electrons};
    c.gain_e_per_dn = c.electrons_per_unit / (scale.dn_per_value * light);
    c.full_well_e =
        arrays.saturation ? *arrays.saturation / light * c.electrons_per_unit : kMaxWellElectrons;
    return c;
}

std::string provenance_of(const MeasuredArrays& arrays, double light) {
    toml::table table{{"importer", std::string("stipple ") + version()}, {"light", light}};
    const auto add = [&](const char* key, const std::string& file) {
        const std::string name = std::filesystem::path(file).filename().string();
        if (is_plain_text(name, false)) table.insert(key, name);
    };
    add("measurements", arrays.measurement_file);
    add("masks", arrays.mask_file);
    std::ostringstream text;
    text << table << '\n';
    return text.str();
}

void write_slots(const NpyVolume& y, const Scale& scale, const StreamHeader& header,
                 StreamWriter& writer) {
    const ExposureSchedule& schedule = header.schedule;
    SamplePacket packet;
    packet.rows = header.shape.rows;
    for (int m = 0; m < y.layers; ++m)
        for (int phase = 0; phase < schedule.period_slots(); ++phase) {
            packet.dn.clear();
            for (int row = 0; row < header.shape.rows; ++row)
                for_each_readout(schedule, packet.slot, row, header.shape.cols, [&](int col, int) {
                    packet.dn.push_back(scale.dn(y.at(m, row, col)));
                });
            writer.write(packet);
            ++packet.slot;
        }
    writer.finish();
}

}  // namespace

double light_of(const NpyVolume& measurements, const ExposureSchedule& schedule) {
    bool above = false;
    for_each_pixel(schedule, [&](int row, int col, std::span<const Exposure> exposures) {
        if (exposures.empty()) return;
        const double weights = schedule.light_slots(row, col, exposures.front());
        for (int m = 0; m < measurements.layers; ++m)
            above = above || measurements.at(m, row, col) > weights;
    });
    return above ? 255 : 1;
}

std::string unread_text(const ImportedStream& stream, const std::string& mask_file) {
    if (stream.unread_pixels == 0) return {};
    return fmt::format("{}: the masks of {} are 0 in all slots; their measurements are left out",
                       mask_file,
                       counted(static_cast<std::int64_t>(stream.unread_pixels), "pixel"));
}

ImportedStream import_measurements(const MeasuredArrays& arrays, const std::filesystem::path& file,
                                   bool force) {
    check_sizes(arrays);
    const NpyVolume& y = arrays.measurements;
    ExposureSchedule schedule = mask_schedule(arrays.masks, arrays.mask_file, arrays.white);
    const Scale scale = scale_of(range_of(arrays, schedule));
    const double light = arrays.light > 0 ? arrays.light : light_of(y, schedule);
    ImportedStream result{
        .header = StreamHeader{.shape = FrameShape{.rows = y.rows, .cols = y.cols, .planes = 1},
                               .slot_us = arrays.slot_us,
                               .calibration = calibration_of(arrays, scale, light),
                               .schedule = std::move(schedule),
                               .schedule_source = {},
                               .schedule_name = "masks",
                               .provenance = provenance_of(arrays, light),
                               .cfa = arrays.cfa},
        .measurements = y.layers,
        .light = light};
    for_each_pixel(result.header.schedule, [&](int, int, std::span<const Exposure> exposures) {
        if (exposures.empty()) ++result.unread_pixels;
    });
    PendingOutput output(file, force);
    StreamWriter writer(output.partial(), result.header, output.final_path().string());
    write_slots(y, scale, result.header, writer);
    output.commit();
    return result;
}

}  // namespace stipple
