#pragma once

#include <cstddef>

#include "capture/camera_search.h"
#include "capture/capture_session.h"
#include "capture/live_emulator.h"
#include "core/nested_figures.h"
#include "readout/sensor_file.h"

namespace stipple {

// Figures of captures under the names of docs/outputs.md (`capture record`, `capture live`). Those
// of a session, lost frames and transport, are numbers: `add(name, number)` is called for each.

/// The key `lost`: missing frames by their cause.
template <typename Add>
void visit_lost_figures(const SessionTotals& totals, const Add& add) {
    for (std::size_t i = 1; i < kGapCauses.size(); ++i)
        add(kGapCauses[i].name.data(), totals.lost[i]);
}

/// The key `transport`.
template <typename Add>
void visit_transport_figures(const TransportCounts& counts, const Add& add) {
    add("underruns", counts.underruns);
    add("packets_resent", counts.packets_resent);
    add("packets_missing", counts.packets_missing);
    add("socket_drops", counts.socket_drops);
    add("link_faults", counts.link_faults);
    add("size_mismatches", counts.size_mismatches);
}

/// A feature of a camera (`capture features`).
template <typename Add>
void visit_feature_figures(const CameraFeature& feature, const Add& add) {
    add("name", feature.name);
    add("category", feature.category);
    add("type", feature.type);
    add("access", feature.access);
    add("locked", feature.locked);
    add("value", feature.value);
    add("unit", feature.unit);
    add("minimum", feature.minimum);
    add("maximum", feature.maximum);
    add("increment", feature.increment);
    add("choices", feature.choices);
    add("text", feature.text);
}

/// Results of a live emulation.
struct LiveReport {
    const LiveEmulation& emulation;
    const StreamRecorder& recorder;
    const LiveCamera& camera;  ///< stopped
};

/// The figures of a live emulation under their names of docs/outputs.md (`capture live`), in
/// addition to those of its stream (readout/emulation_figures.h) and without `preview`. Calls
/// `add(name, value)` for each; values are numbers, std::nullopt, and those of
/// core/nested_figures.h.
template <typename Add>
void visit_live_figures(const LiveReport& report, const Add& add) {
    const LiveEmulation& live = report.emulation;
    add("frames", live.latencies.count());
    add("frames_hz", live.rate.hz());
    add("slots_hz", 1e6 / report.recorder.emulator().setup().params.slot_us);
    add("incomplete", live.totals.incomplete);
    add("repeated", live.totals.repeated);
    add("lost", NestedFigures{[&](const auto& inner) { visit_lost_figures(live.totals, inner); }});
    add("missing_before_first", live.totals.missing_before_first);
    add("transport", NestedFigures{[&](const auto& inner) {
            visit_transport_figures(report.camera.transport(), inner);
        }});
    add("held_slots", live.held_slots);
    add("dropped_slots", live.dropped_slots);
    add("unheld_slots", live.unheld_slots);
    add("late_slots", live.late_slots);
    add("late", FigureList{live.late, [](const LateSlot& late, const auto& inner) {
                               inner("slot", late.slot);
                               inner("arrival_monotonic_ns", late.arrival_ns);
                               inner("latency_us", late.latency_us);
                           }});
    add("queue_peak_frames", report.camera.peak());
    add("latency_us", NestedFigures{[&](const auto& inner) {
            inner("median", live.latencies.quantile_us(0.5));
            inner("p99", live.latencies.quantile_us(0.99));
            inner("max", live.latencies.longest_us());
        }});
}

}  // namespace stipple
