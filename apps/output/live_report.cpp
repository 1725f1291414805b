#include "apps/output/session_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/output/emulation_text.h"
#include "apps/output/text_layout.h"
#include "study/report/json_figures.h"

namespace stipple {

nlohmann::ordered_json live_json(const LiveReport& report) {
    const LiveEmulation& live = report.emulation;
    nlohmann::ordered_json json = emulation_json(report.recorder, live.slots_per_second);
    json.update(json_of([&](const auto& add) { visit_live_figures(report, add); }));
    return json;
}

std::string live_text(const LiveReport& report, const std::string& output,
                      double late_after_slots) {
    const LiveEmulation& live = report.emulation;
    return fmt::format(
        "{}: {}\n{}, {} late (more than {} slots), {} held for frames that are missing or "
        "incomplete{}{}\n"
        "lost: {}; incomplete: {}{}\n"
        "frame in to packet out: median {:.2f} ms, 99 % within {:.2f} ms, all within {:.2f} ms",
        output, emulation_text(report.recorder, live.slots_per_second),
        counted(live.latencies.count(), "frame"), counted(live.late_slots, "slot"),
        late_after_slots, live.held_slots,
        live.unheld_slots == 0 ? "" : fmt::format(", {} left out", live.unheld_slots),
        live.dropped_slots == 0
            ? ""
            : fmt::format(", {} of them without samples as the emulation was too slow",
                          live.dropped_slots),
        lost_text(live.totals), live.totals.incomplete,
        live.totals.missing_before_first == 0
            ? ""
            : fmt::format("; before the first slot: {}", live.totals.missing_before_first),
        live.latencies.quantile_us(0.5) * 1e-3, live.latencies.quantile_us(0.99) * 1e-3,
        live.latencies.longest_us() * 1e-3);
}

}  // namespace stipple
