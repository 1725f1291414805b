#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/message.h"

namespace stipple {

/// Size of a tile in space and time.
struct TileSize {
    int rows = 0;
    int cols = 0;
    int period_slots = 0;
};

/// Max characters (pixels x slots) of a code, which are read or written in a second.
inline constexpr std::size_t kMaxCodeSlots = std::size_t{1} << 24U;

/// The schedule of a written-out code: one string per tile pixel, row by row, one character per
/// slot.
/// '.' is closed; 'A' begins an exposure in the first charge store and 'a' continues it, 'B' and
/// 'b' in the second; other characters in between are gaps of it. 'a' before the first 'A'
/// continues the last exposure of the previous period. An exposure is read in its last open slot.
/// \throws InputError at `where`, naming pixel and slot, for another character, a string of another
/// length, an exposure without beginning or with more than 64 slots from its first to its last.
[[nodiscard]] ExposureSchedule code_schedule(TileSize size, std::span<const std::string> code,
                                             const Message& where);

/// The weights of a written-out code, order (slot, row, col), for ExposureSchedule::set_weights:
/// one string per tile pixel, four hexadecimal digits per slot, FFFF is 1 and 0000 a closed slot.
/// \throws InputError at `where`, naming the pixel, for another character or length.
[[nodiscard]] std::vector<float> code_weights(TileSize size, std::span<const std::string> texts,
                                              const Message& where);

/// A file of kind "code" that holds `schedule`, or two periods of it if exposures change their
/// store from one period to the next. `name` is the value of its key `name`. \throws InputError if
/// the schedule needs more than two charge stores, has more than kMaxCodeSlots pixels x slots, or
/// has a weight above 1. Weights are rounded to 1/65535, but not to 0.
[[nodiscard]] std::string code_text(const ExposureSchedule& schedule, const std::string& name);

}  // namespace stipple
