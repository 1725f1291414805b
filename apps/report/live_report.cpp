#include "apps/report/live_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/report/emulation_text.h"
#include "apps/report/json_figures.h"
#include "apps/report/number_text.h"
#include "apps/report/session_report.h"

namespace stipple {

nlohmann::ordered_json live_json(const LiveReport& report) {
    const LiveEmulation& live = report.emulation;
    nlohmann::ordered_json json = emulation_json(report.recorder, live.slots_per_second);
    json["frames"] = live.latencies.count();
    json["frames_hz"] = or_null(live.rate.hz());
    json["slots_hz"] = 1e6 / report.recorder.setup().params.slot_us;
    json["incomplete"] = live.totals.incomplete;
    json["repeated"] = live.totals.repeated;
    json["lost"] = lost_json(live.totals);
    json["missing_before_first"] = live.totals.missing_before_first;
    json["transport"] = transport_json(report.camera.transport());
    json["held_slots"] = live.held_slots;
    json["unheld_slots"] = live.unheld_slots;
    json["late_slots"] = live.late_slots;
    json["late"] = nlohmann::ordered_json::array();
    for (const LateSlot& late : live.late)
        json["late"].push_back({{"slot", late.slot},
                                {"arrival_monotonic_ns", late.arrival_ns},
                                {"latency_us", late.latency_us}});
    json["queue_peak_frames"] = report.camera.peak();
    json["latency_us"] = {{"median", live.latencies.quantile_us(0.5)},
                          {"p99", live.latencies.quantile_us(0.99)},
                          {"max", live.latencies.longest_us()}};
    return json;
}

std::string live_text(const LiveReport& report, const std::string& output,
                      double late_after_slots) {
    const LiveEmulation& live = report.emulation;
    return fmt::format(
        "{}: {}\n{}, {} late (more than {} slots), {} held for frames that are missing or "
        "incomplete{}\n"
        "lost: {}; incomplete: {}{}\n"
        "frame in to packet out: median {:.2f} ms, 99 % within {:.2f} ms, all within {:.2f} ms",
        output, emulation_text(report.recorder, live.slots_per_second),
        counted(live.latencies.count(), "frame"), counted(live.late_slots, "slot"),
        late_after_slots, live.held_slots,
        live.unheld_slots == 0 ? "" : fmt::format(", {} left out", live.unheld_slots),
        lost_text(live.totals), live.totals.incomplete,
        live.totals.missing_before_first == 0
            ? ""
            : fmt::format("; before the first slot: {}", live.totals.missing_before_first),
        live.latencies.quantile_us(0.5) * 1e-3, live.latencies.quantile_us(0.99) * 1e-3,
        live.latencies.longest_us() * 1e-3);
}

}  // namespace stipple
