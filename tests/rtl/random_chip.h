#pragma once

#include <cstdint>
#include <string>

#include "core/exposure_schedule.h"
#include "readout/timing/readout_timing.h"
#include "tests/readout/timing/random_readout.h"
#include "tests/rtl/chip_run.h"

namespace stipple {

/// The verilated chip of this name.
[[nodiscard]] const ChipModel& model(const std::string& name);

/// The timing of a sensor on the structure of a chip.
[[nodiscard]] ReadoutTiming fitted(ReadoutTiming timing, const ChipParameters& size);

/// Times of a random sensor that a chip of this size can have.
[[nodiscard]] ReadoutTiming random_chip_timing(const ChipParameters& size, Draw& draw);

/// A schedule for a chip: as gapped as its memory can say.
[[nodiscard]] ExposureSchedule schedule_for(const ChipParameters& size, std::uint32_t seed,
                                            Draw& draw);

}  // namespace stipple
