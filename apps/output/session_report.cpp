#include "apps/output/session_report.h"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/standard_streams.h"
#include "capture/capture_figures.h"
#include "core/error.h"
#include "study/report/json_figures.h"

namespace stipple {

nlohmann::ordered_json lost_json(const SessionTotals& totals) {
    return json_of([&](const auto& add) { visit_lost_figures(totals, add); });
}

std::string lost_text(const SessionTotals& totals) {
    std::string text;
    for (std::size_t i = 1; i < kGapCauses.size(); ++i)
        if (const auto frames = totals.lost[i]; frames > 0)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", frames, kGapCauses[i].name);
    return text.empty() ? "none" : text;
}

nlohmann::ordered_json transport_json(const TransportCounts& counts) {
    return json_of([&](const auto& add) { visit_transport_figures(counts, add); });
}

std::string losses_text(const SessionTotals& totals) {
    const auto lost = std::accumulate(totals.lost.begin(), totals.lost.end(), std::uint64_t{0});
    if (lost + totals.incomplete == 0) return {};
    return fmt::format("{} lost, {} incomplete", lost, totals.incomplete);
}

void throw_if_lost(const std::string& losses, const std::string& file) {
    if (!losses.empty()) throw DeviceError(file, losses + "; the file is kept (--fail-on-loss)");
}

void say_event(const SessionEvent& event) {
    if (const auto* const outage = std::get_if<Outage>(&event))
        say_warning("camera lost ({}); reopening it", outage->reason);
    if (const auto* const recovery = std::get_if<Recovery>(&event))
        say_note("the camera is back after {:.1f} s", recovery->gone_s);
    if (const auto* const lost = std::get_if<DeviceLost>(&event)) say_warning(lost->warning);
}

void say_warnings(const CameraDescription& camera) {
    for (const Message& warning : camera.warnings) say_warning(warning);
}

}  // namespace stipple
