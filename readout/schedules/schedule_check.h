#pragma once

#include <optional>
#include <string>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "readout/timing/column_addressing.h"
#include "readout/timing/readout_timing.h"

namespace stipple {

/// Why pixels with `charge_stores` charge stores cannot do what the schedule says: names the first
/// pixel and slot in which more exposures are under way. Nothing if they can.
[[nodiscard]] std::optional<std::string> store_problem(const ExposureSchedule& schedule,
                                                       int charge_stores);

/// Why a sensor cannot read an array of `shape` by this schedule within slots of `slot_us`: names
/// the slot of the period that takes longest, and what limits it. Nothing if it can, or if nothing
/// is read. \throws InputError as ReadoutAccount.
[[nodiscard]] std::optional<std::string> timing_problem(const ExposureSchedule& schedule,
                                                        const ReadoutTiming& timing,
                                                        FrameShape shape, double slot_us);

/// Names the first pixel whose exposures are not those of the group it is read with. That is no
/// fault, but the group is transferred whole whenever one of its pixels is due. Nothing if pixels
/// of a group are alike, or columns are not read in groups.
[[nodiscard]] std::optional<std::string> group_remark(const ExposureSchedule& schedule,
                                                      const ColumnAddressing& addressing,
                                                      FrameShape shape);

}  // namespace stipple
