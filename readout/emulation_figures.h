#pragma once

#include "readout/stream_recorder.h"

namespace stipple {

/// Figures of a recorded stream under their names of docs/cli.md (`emulate`), without its speed and
/// the cost of its readout (`visit_cost_figures`). Calls `add(name, number)` for each.
template <typename Add>
void visit_emulation_figures(const StreamRecorder& recorder, const Add& add) {
    add("slots", recorder.stats().slots);
    add("samples", recorder.samples());
    add("payload_bits", recorder.payload_bits());
    add("compression_ratio", recorder.compression_ratio());
    add("light_throughput", recorder.light_throughput());
    add("light_read", recorder.light_read());
    add("saturated_fraction", recorder.saturated_fraction());
}

}  // namespace stipple
