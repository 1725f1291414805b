#include "readout/rig_figures.h"

#include "readout/sensor_file.h"
#include "readout/stream_recorder.h"
#include "readout/timing/readout_cost.h"

namespace stipple {

void RigTotals::add(const StreamRecorder& recorder, double share) {
    constexpr double kMicrosecond = 1e-6;
    constexpr double kPicojoulePerMicrojoule = 1e6;
    const double slot_bits = static_cast<double>(recorder.payload_bits()) /
                             static_cast<double>(recorder.emulator().stats().slots);
    samples += recorder.samples();
    payload_bits += recorder.payload_bits();
    light_collected += share * recorder.emulator().light_throughput();
    bits_per_slot += slot_bits;
    bits_per_second += slot_bits / (recorder.emulator().setup().params.slot_us * kMicrosecond);
    const ReadoutCost* cost = recorder.emulator().readout_cost();
    if (cost == nullptr)
        energy_uj.reset();
    else if (energy_uj)
        *energy_uj += cost->totals().energy_pj / kPicojoulePerMicrojoule;
}

}  // namespace stipple
