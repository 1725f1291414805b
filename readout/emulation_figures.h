#pragma once

#include <optional>

#include "readout/stream_recorder.h"

namespace stipple {

/// Figures of a recorded stream under their names of docs/outputs.md (`emulate`), without its speed
/// and the cost of its readout (`visit_cost_figures`). Calls `add(name, number)` for each.
template <typename Add>
void visit_emulation_figures(const StreamRecorder& recorder, const Add& add) {
    add("slots", recorder.emulator().stats().slots);
    add("samples", recorder.samples());
    add("payload_bits", recorder.payload_bits());
    add("compression_ratio", recorder.compression_ratio());
    add("light_throughput", recorder.emulator().light_throughput());
    add("light_read", recorder.emulator().light_read());
    add("saturated_fraction", recorder.saturated_fraction());
    add("zero_fraction", recorder.zero_fraction());
}

/// The speed of an emulation; std::nullopt where it is not known.
template <typename Add>
void visit_speed_figures(const StreamRecorder& recorder, std::optional<double> slots_per_second,
                         const Add& add) {
    const ReadoutStats& stats = recorder.emulator().stats();
    std::optional<double> samples_per_s;
    if (slots_per_second)
        samples_per_s = *slots_per_second * static_cast<double>(stats.samples) /
                        static_cast<double>(stats.slots);
    add("slots_per_second", slots_per_second);
    add("samples_per_second", samples_per_s);
}

}  // namespace stipple
