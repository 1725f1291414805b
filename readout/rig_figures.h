#pragma once

#include <cstdint>
#include <optional>

namespace stipple {

class StreamRecorder;

/// Sums over the sensors of a rig.
struct RigTotals {
    std::uint64_t samples = 0;
    std::uint64_t payload_bits = 0;
    double light_collected = 0;  ///< sum of share x light throughput; 1: all light of one aperture
    double bits_per_slot = 0;
    double bits_per_second = 0;
    /// Of the readouts; none if a sensor has no timing.
    std::optional<double> energy_uj = 0.0;

    /// Adds a sensor with this share of the light. Precondition: it has a slot.
    void add(const StreamRecorder& recorder, double share);
};

/// The totals under their names of docs/outputs.md; calls `add(name, value)` for each.
template <typename Add>
void visit_rig_figures(const RigTotals& totals, const Add& add) {
    add("samples", totals.samples);
    add("payload_bits", totals.payload_bits);
    add("light_collected", totals.light_collected);
    add("bits_per_slot", totals.bits_per_slot);
    add("bits_per_second", totals.bits_per_second);
    add("energy_uj", totals.energy_uj);
}

}  // namespace stipple
