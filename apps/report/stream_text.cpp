#include "apps/report/stream_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "apps/report/number_text.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

bool is_random(const StreamHeader& header) {
    return header.schedule_source.kind == ScheduleSource::Kind::kRandom;
}

/// Rows and columns; of a random schedule the reader has kept one pixel only.
std::pair<int, int> tile_of(const StreamHeader& header) {
    if (is_random(header)) return {header.shape.rows, header.shape.cols};
    return {header.schedule.tile_rows(), header.schedule.tile_cols()};
}

ordered_json calibration_json(const Calibration& calibration) {
    ordered_json responsivity = ordered_json::array(), conversion_gain = ordered_json::array();
    for (const CalibrationPixel& pixel : calibration.tile.pixels) {
        responsivity.push_back(pixel.responsivity);
        conversion_gain.push_back(pixel.conversion_gain);
    }
    return {{"bit_depth", calibration.bit_depth},
            {"rounding", name_of(calibration.rounding)},
            {"black_level_dn", calibration.black_level_dn},
            {"gain_e_per_dn", calibration.gain_e_per_dn},
            {"read_noise_e", calibration.read_noise_e},
            {"full_well_e", calibration.full_well_e},
            {"electrons_per_unit", calibration.electrons_per_unit},
            {"dark_e_per_slot", calibration.dark_e_per_slot},
            {"tile_rows", calibration.tile.rows},
            {"tile_cols", calibration.tile.cols},
            {"responsivity", responsivity},
            {"conversion_gain", conversion_gain}};
}

ordered_json schedule_json(const StreamHeader& header) {
    const ExposureSchedule& schedule = header.schedule;
    const auto [tile_rows, tile_cols] = tile_of(header);
    ordered_json json{{"name", header.schedule_name},
                      {"tile_rows", tile_rows},
                      {"tile_cols", tile_cols},
                      {"period_slots", schedule.period_slots()},
                      {"samples_per_pixel_slot", schedule.samples_per_pixel_slot()},
                      {"light_throughput", schedule.light_throughput()},
                      {"gapless", schedule.gapless()},
                      {"interleaved", schedule.interleaved()}};
    if (is_random(header)) {
        json["exposure_slots"] = header.schedule_source.exposure_slots;
        json["seed"] = header.schedule_source.seed;
    }
    return json;
}

/// What only some sensors have, a line each.
std::string special_text(const StreamHeader& header) {
    const Calibration& calibration = header.calibration;
    std::string text;
    if (header.cfa != ColourFilter::kNone)
        text += fmt::format("colours      filter array {}\n", name_of(header.cfa));
    if (calibration.dark_e_per_slot != 0)
        text += fmt::format("dark signal  {:.4g} e per slot\n", calibration.dark_e_per_slot);
    if (!calibration.tile.pixels.empty())
        text += fmt::format("pixels       differ, tile {} x {}\n", calibration.tile.rows,
                            calibration.tile.cols);
    return text;
}

}  // namespace

ordered_json stream_json(const StreamHeader& header, const StreamReport& report) {
    ordered_json damage = ordered_json::array();
    for (const StreamDamage& where : report.damage)
        damage.push_back(
            {{"offset", where.offset}, {"bytes", where.bytes}, {"cause", where.cause}});
    return {{"version", report.version},
            {"rows", header.shape.rows},
            {"cols", header.shape.cols},
            {"planes", header.shape.planes},
            {"cfa", name_of(header.cfa)},
            {"slot_us", header.slot_us},
            {"calibration", calibration_json(header.calibration)},
            {"schedule", schedule_json(header)},
            {"provenance", header.provenance},
            {"slots", report.slots},
            {"packets", report.packets},
            {"samples", report.samples},
            {"payload_bits", report.payload_bits},
            {"missing_slots", report.missing_slots},
            {"complete", report.complete},
            {"tail_bytes", report.tail_bytes},
            {"damage", damage},
            {"unlisted_damage", report.unlisted_damage}};
}

std::string stream_text(const StreamHeader& header, const StreamReport& report) {
    const Calibration& calibration = header.calibration;
    const ExposureSchedule& schedule = header.schedule;
    const auto [tile_rows, tile_cols] = tile_of(header);
    return fmt::format(
        "frames       {} x {} x {} (width x height x planes), a slot is {} us\n"
        "samples      {} bits, {:.5g} e/DN, black level {} DN, read noise {} e, full well {} e\n"
        "light 1.0    {} e per slot\n"
        "{}"
        "schedule     {}: tile {} x {}, period {} slots, {:.4g} samples per pixel and slot,\n"
        "             light throughput {:.1f} %\n"
        "holds        {} slots, {} packets, {} samples, {} payload bits",
        header.shape.cols, header.shape.rows, header.shape.planes, header.slot_us,
        calibration.bit_depth, calibration.gain_e_per_dn, calibration.black_level_dn,
        calibration.read_noise_e, calibration.full_well_e, calibration.electrons_per_unit,
        special_text(header), header.schedule_name, tile_rows, tile_cols, schedule.period_slots(),
        schedule.samples_per_pixel_slot(), 100 * schedule.light_throughput(), report.slots,
        report.packets, report.samples, report.payload_bits);
}

bool undamaged(const StreamReport& report) {
    return report.damage.empty() && report.missing_slots == 0 && report.tail_bytes == 0;
}

std::string damage_text(const StreamReport& report) {
    constexpr std::size_t kMaxPlaces = 10;
    const std::uint64_t places = report.damage.size() + report.unlisted_damage;
    const std::size_t listed = std::min(report.damage.size(), kMaxPlaces);
    if (report.damage.empty() && report.missing_slots == 0)
        return fmt::format(
            "the stream is cut off: {} are whole, then it ends within a packet, "
            "of which there are {} bytes",
            counted(report.slots, "slot"), report.tail_bytes);
    std::string text = fmt::format("the stream is damaged; {} of {} slots are incomplete",
                                   report.missing_slots, report.slots);
    for (const StreamDamage& where : std::span(report.damage).first(listed))
        text += fmt::format("\n  byte {}: {}, {} bytes skipped", where.offset, where.cause,
                            where.bytes);
    if (places > listed) text += fmt::format("\n  and {} more", places - listed);
    if (report.tail_bytes > 0)
        text += fmt::format("\n  the file ends within a packet, its last {} bytes are unused",
                            report.tail_bytes);
    return text;
}

}  // namespace stipple
