#include "study/report/stream_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "readout/provenance.h"
#include "stream/stream_figures.h"
#include "study/report/json_figures.h"
#include "study/report/schedule_text.h"

namespace stipple {
namespace {

/// Least and most of the weights of open slots.
std::pair<float, float> open_weights(const ExposureSchedule& schedule) {
    std::pair range{kMaxSlotWeight, kMinSlotWeight};
    for (const float weight : schedule.weights())
        if (weight > 0) range = {std::min(range.first, weight), std::max(range.second, weight)};
    return range;
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
    if (calibration.noise_free) text += "noise        none but rounding\n";
    if (header.schedule.weighted()) {
        const auto [least, most] = open_weights(header.schedule);
        text +=
            fmt::format("masks        grey, weights of open slots {:.4g} .. {:.4g}\n", least, most);
    }
    return text;
}

/// Where the schedule changes, if it does: the first ten places.
std::string switches_text(const StreamHeader& header) {
    constexpr std::size_t kShown = 10;
    const std::size_t all = header.switches.size();
    std::string text;
    for (std::size_t i = 0; i < std::min(all, kShown); ++i)
        text += fmt::format("\nfrom slot    {} schedule {}", header.switches[i].slot,
                            header.switches[i].name);
    return all > kShown ? text + fmt::format(", and {} more", all - kShown) : text;
}

}  // namespace

nlohmann::ordered_json filter_json(ColourFilter cfa) {
    if (cfa == ColourFilter::kNone) return nullptr;
    return {colour_plane(cfa, 0, 0), colour_plane(cfa, 0, 1), colour_plane(cfa, 1, 0),
            colour_plane(cfa, 1, 1)};
}

nlohmann::ordered_json stream_json(const StreamHeader& header, const StreamReport& report) {
    auto json = nlohmann::ordered_json::object();
    json["version"] = report.version;
    json.update(json_of([&](const auto& add) { visit_header_figures(header, add); }));
    json["calibration"] =
        json_of([&](const auto& add) { visit_calibration_figures(header.calibration, add); });
    json["schedule"] = json_of([&](const auto& add) { visit_schedule_figures(header, add); });
    for (const ScheduleSwitch& part : header.switches)
        json["switches"].push_back(
            json_of([&](const auto& add) { visit_switch_figures(part, add); }));
    json["provenance"] = header.provenance;
    json.update(json_of([&](const auto& add) { visit_report_figures(report, add); }));
    auto& damage = json["damage"] = nlohmann::ordered_json::array();
    for (const StreamDamage& place : report.damage)
        damage.push_back(json_of([&](const auto& add) { visit_damage_figures(place, add); }));
    json["unlisted_damage"] = report.unlisted_damage;
    return json;
}

nlohmann::ordered_json run_json(const std::string& name, const StreamHeader& header,
                                const StreamReport& report, std::int64_t slots) {
    constexpr int kLanes = 12;               // pixels of the diagram
    constexpr std::int64_t kLaneSlots = 64;  // the most slots of it
    const std::int64_t end =
        header.switches.empty() ? slots : std::min(slots, header.switches.front().slot);
    return {{"name", name},
            {"stream", stream_json(header, report)},
            {"command", or_null(command_of(header.provenance))},
            {"filter", filter_json(header.cfa)},
            {"lanes", lanes_json(header.schedule, header.shape, kLanes,
                                 std::clamp(end, std::int64_t{1}, kLaneSlots))}};
}

std::string stream_text(const StreamHeader& header, const StreamReport& report) {
    const Calibration& calibration = header.calibration;
    const ExposureSchedule& schedule = header.schedule;
    const TileShape tile = tile_shape_of(header);
    return fmt::format(
        "frames       {} x {} x {} (width x height x planes), a slot is {} us\n"
        "samples      {} bits, {:.5g} e/DN, black level {} DN, read noise {} e, full well {} e\n"
        "light 1.0    {} e per slot\n"
        "{}"
        "schedule     {}: tile {} x {}, period {} slots, {:.4g} samples per pixel and slot,\n"
        "             light throughput {:.1f} %\n"
        "holds        {} slots, {} packets, {} samples, {} payload bits{}",
        header.shape.cols, header.shape.rows, header.shape.planes, header.slot_us,
        calibration.bit_depth, calibration.gain_e_per_dn, calibration.black_level_dn,
        calibration.read_noise_e, calibration.full_well_e, calibration.electrons_per_unit,
        special_text(header), header.schedule_name, tile.rows, tile.cols, schedule.period_slots(),
        schedule.samples_per_pixel_slot(), 100 * schedule.light_throughput(), report.slots,
        report.packets, report.samples, report.payload_bits, switches_text(header));
}

}  // namespace stipple
