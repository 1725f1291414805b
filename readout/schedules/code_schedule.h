#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/exposure_schedule.h"

namespace stipple {

/// Size of a tile in space and time.
struct TileSize {
    int rows = 0;
    int cols = 0;
    int period_slots = 0;
};

/// The most characters, pixels x slots, that a code may have: what reads and writes in a second.
inline constexpr std::size_t kMaxCodeSlots = std::size_t{1} << 24U;

/// The schedule that is written out: one string per tile pixel, row by row, one character per slot.
/// '.' is closed; 'A' begins an exposure in the first charge store and 'a' goes on with it, 'B' and
/// 'b' the same in the second; other characters in between are gaps of it. What comes before the
/// first 'A' goes on with the last one, around the period. It is read in its last open slot.
/// \throws InputError at `place`, naming pixel and slot, for another character, a string of another
/// length, an exposure without beginning or with more than 64 slots from its first to its last.
[[nodiscard]] ExposureSchedule code_schedule(TileSize size, std::span<const std::string> code,
                                             const std::string& place);

/// A file of kind "code" that holds `schedule`. Where stores change sides from one period to the
/// next it holds two periods. `name` is its key of the same name.
/// \throws InputError if the schedule needs more than two charge stores or has more than
/// kMaxCodeSlots pixels x slots.
[[nodiscard]] std::string code_text(const ExposureSchedule& schedule, const std::string& name);

}  // namespace stipple
