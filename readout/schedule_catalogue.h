#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/config.h"
#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "stream/stream_header.h"

namespace stipple {

struct ColumnAddressing;

/// A schedule with what a stream header says of it.
struct NamedSchedule {
    std::string name;
    ScheduleSource source;
    ExposureSchedule schedule;
};

/// The schedule that a file of config/schedules describes (key `kind`, docs/schedules.md), made for
/// an array of `shape` with `seed`. Other keys are left for the caller's `reject_unknown_keys`.
/// Schedules made for the hardware suit `addressing`, the sensor's, where the file says nothing
/// else. \throws InputError naming file, line and key.
[[nodiscard]] NamedSchedule read_schedule(Config& config, FrameShape shape, std::uint64_t seed,
                                          const ColumnAddressing& addressing);

/// For a sensor that skips pixel by pixel, the default of ColumnAddressing.
[[nodiscard]] NamedSchedule read_schedule(Config& config, FrameShape shape, std::uint64_t seed);

/// A seeded tile in which every pixel repeats its own permutation of `exposure_slots` without
/// gaps, and the number of pixels due per slot is as even as possible over the period.
/// \throws InputError if a length is outside 1..64 or the tile is empty or beyond 256 x 256.
[[nodiscard]] ExposureSchedule tiled_schedule(int tile_rows, int tile_cols,
                                              std::span<const int> exposure_slots,
                                              std::uint64_t seed);

/// Every pixel of the array exposes `open_slots` slots together, every `period_slots` slots: a
/// conventional camera. \throws InputError unless 1 <= open_slots <= 64, open_slots <= period.
[[nodiscard]] ExposureSchedule full_schedule(int open_slots, int period_slots);

}  // namespace stipple
