#pragma once

#include <cstdint>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "readout/timing/full_readout.h"
#include "readout/timing/readout_timing.h"
#include "readout/timing/scan_cost.h"

namespace stipple {

/// Rates of full and of coded readout of a window. Full readouts follow each other without a pause.
struct ReadoutRate {
    UniformReadout full;
    BalancedReadout balanced;  ///< the upper bound: balanced load
    /// The shortest slots, all of one length, in which each scan of the steady period meets its
    /// deadline (`ScanCosts`); at least the code load.
    double min_slot_clocks = 0;
    ScanCost slowest;  ///< the scan that sets it; of code load, the longest scan
    std::int64_t slowest_phase = 0;
    int deadline_slots = 0;       ///< of `slowest`
    double mean_slot_clocks = 0;  ///< if samples could wait as long as they like
    ReadoutCounts period;         ///< of all slots of a steady period
    double full_hz = 0;           ///< readouts of the whole window per second
    double coded_hz = 0;          ///< slots of `min_slot_clocks` per second
    double mean_coded_hz = 0;     ///< slots of `mean_slot_clocks` per second
    double speedup = 0;           ///< coded_hz / full_hz
    double balanced_speedup = 0;  ///< of `balanced`, limited by the code load too
    double full_energy_pj = 0;
};

/// `exposure_clocks`: of a slot. A sensor that cannot expose while it reads lengthens its slots by
/// its readouts; the rate of another one does not depend on it.
/// \throws InputError as `check_window`, or if the schedule reads no pixel of the window.
[[nodiscard]] ReadoutRate rate_of(const ReadoutTiming& timing, const ExposureSchedule& schedule,
                                  FrameShape shape, std::int64_t exposure_clocks);

}  // namespace stipple
