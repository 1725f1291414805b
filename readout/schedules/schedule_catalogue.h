#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/config.h"
#include "core/geometry.h"
#include "readout/schedules/named_schedule.h"

namespace stipple {

struct ColumnAddressing;

/// The schedule that a file of config/schedules describes (key `kind`, docs/schedules.md), made for
/// an array of `shape` with `seed`. Other keys are left for the caller's `reject_unknown_keys`.
/// Schedules made for the hardware suit `addressing`, the sensor's, where the file says nothing
/// else. \throws InputError naming file, line and key.
[[nodiscard]] NamedSchedule read_schedule(Config& config, FrameShape shape, std::uint64_t seed,
                                          const ColumnAddressing& addressing);

/// The values of the key `kind`.
[[nodiscard]] std::vector<std::string_view> schedule_kinds();

/// The keys of schedules of a kind. Precondition: one of `schedule_kinds`.
[[nodiscard]] std::vector<KnownKey> known_schedule_keys(std::string_view kind);

/// For a sensor that skips pixel by pixel, the default of ColumnAddressing.
[[nodiscard]] NamedSchedule read_schedule(Config& config, FrameShape shape, std::uint64_t seed);

}  // namespace stipple
