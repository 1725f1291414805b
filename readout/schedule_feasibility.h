#pragma once

#include <optional>
#include <string>

#include "core/geometry.h"

namespace stipple {

class ExposureSchedule;
struct ColumnAddressing;
struct ReadoutTiming;
struct SensorSetup;

/// Message if the schedule needs more than `charge_stores` charge stores per pixel: names the first
/// pixel and slot with more exposures under way. Else nothing.
[[nodiscard]] std::optional<std::string> store_problem(const ExposureSchedule& schedule,
                                                       int charge_stores);

/// Message if a sensor cannot read an array of `shape` by this schedule within slots of `slot_us`:
/// names the slowest slot of the period and its limit. Nothing if it can, or if nothing is read.
/// \throws InputError as ReadoutCost.
[[nodiscard]] std::optional<std::string> timing_problem(const ExposureSchedule& schedule,
                                                        const ReadoutTiming& timing,
                                                        FrameShape shape, double slot_us);

/// The first of these problems of a sensor with its schedule; without a timing only
/// `store_problem`.
[[nodiscard]] std::optional<std::string> schedule_problem(const SensorSetup& setup);

/// Remark that names the first pixel whose exposures differ from those of its group. This is
/// allowed, but the group is transferred whole whenever one of its pixels is due. Nothing if the
/// pixels of each group are equal, or if columns are not read in groups.
[[nodiscard]] std::optional<std::string> group_remark(const ExposureSchedule& schedule,
                                                      const ColumnAddressing& addressing,
                                                      FrameShape shape);

}  // namespace stipple
