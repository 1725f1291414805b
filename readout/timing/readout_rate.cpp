#include "readout/timing/readout_rate.h"

#include <algorithm>

#include "core/error.h"
#include "readout/schedules/full_schedule.h"

namespace stipple {
namespace {

double per_second(const ReadoutTiming& timing, double clocks) {
    return static_cast<double>(timing.clock_hz) / clocks;
}

/// Energy of a readout of the whole window, which needs no exposure code.
double full_energy_pj(ReadoutTiming timing, FrameShape shape) {
    timing.code_bit_pj = 0;
    const ExposureSchedule every_slot = full_schedule(1, 1);
    return ReadoutCost(timing, every_slot, shape, {}).of(0).counts.energy_pj;
}

}  // namespace

ReadoutRate rate_of(const ReadoutTiming& timing, const ExposureSchedule& schedule,
                    FrameShape shape) {
    ReadoutRate rate;
    rate.full = full_readout(timing, shape);
    rate.full_energy_pj = full_energy_pj(timing, shape);
    ReadoutCost cost(timing, schedule, shape, {});
    const std::int64_t first = cost.first_steady_slot();
    const int period = schedule.period_slots();
    double clocks = 0;
    for (std::int64_t slot = first; slot < first + period; ++slot) {
        const SlotCost& it = cost.of(slot);
        rate.period += it.counts;
        clocks += static_cast<double>(it.clocks);
        if (it.clocks <= rate.slowest.clocks) continue;
        rate.slowest = it;
        rate.slowest_phase = slot % period;
    }
    if (rate.period.samples == 0)
        throw InputError("exposure schedule", "reads no pixel of the window");
    rate.mean_slot_clocks = clocks / period;
    const double samples_per_slot = static_cast<double>(rate.period.samples) / period;
    rate.balanced =
        balanced_readout(timing, shape, samples_per_slot / static_cast<double>(shape.sites()));
    const double balanced_clocks =
        std::max(rate.balanced.total, static_cast<double>(cost.timing().code_load_clocks));
    rate.full_hz = per_second(timing, static_cast<double>(rate.full.total));
    rate.coded_hz = per_second(timing, static_cast<double>(rate.slowest.clocks));
    rate.mean_coded_hz = per_second(timing, rate.mean_slot_clocks);
    rate.speedup = rate.coded_hz / rate.full_hz;
    rate.balanced_speedup = static_cast<double>(rate.full.total) / balanced_clocks;
    return rate;
}

}  // namespace stipple
