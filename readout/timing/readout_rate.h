#pragma once

#include <cstdint>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "readout/timing/full_readout.h"
#include "readout/timing/readout_cost.h"
#include "readout/timing/readout_timing.h"

namespace stipple {

/// Rates of full and of coded readout of a window, each readout right after the previous one.
struct ReadoutRate {
    UniformReadout full;
    BalancedReadout balanced;  ///< the upper bound: balanced load
    SlotCost slowest;          ///< slot of the steady period
    std::int64_t slowest_phase = 0;
    double mean_slot_clocks = 0;
    ReadoutCounts period;         ///< of all slots of a steady period
    double full_hz = 0;           ///< readouts of the whole window per second
    double coded_hz = 0;          ///< slots per second, as the slowest slot allows
    double mean_coded_hz = 0;     ///< slots per second if each lasts as long as its readout
    double speedup = 0;           ///< coded_hz / full_hz
    double balanced_speedup = 0;  ///< of `balanced`, limited by the code load too
    double full_energy_pj = 0;
};

/// \throws InputError as `check_window`, or if the schedule reads no pixel of the window.
[[nodiscard]] ReadoutRate rate_of(const ReadoutTiming& timing, const ExposureSchedule& schedule,
                                  FrameShape shape);

}  // namespace stipple
