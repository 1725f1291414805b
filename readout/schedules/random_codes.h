#pragma once

#include <cstdint>
#include <span>

#include "core/exposure_schedule.h"

namespace stipple {

/// A tile whose pixels repeat exposures at random places of the period.
struct Scatter {
    int tile_rows = 1;
    int tile_cols = 1;
    int period_slots = 1;
    bool wrap = true;  ///< exposures may go on beyond the end of the period, into its begin
};

/// Every pixel has one exposure of each of the lengths `exposure_slots`, in random order. All
/// places are equally likely. \throws InputError if a length is outside 1..64, or their sum is
/// longer than the period.
[[nodiscard]] ExposureSchedule scattered_schedule(const Scatter& scatter,
                                                  std::span<const int> exposure_slots,
                                                  std::uint64_t seed);

/// A tile whose pixels repeat exposures with random gaps (flutter).
struct Flutter {
    int tile_rows = 1;
    int tile_cols = 1;
    int code_slots = 1;       ///< span of an exposure, 1..64
    int open_slots = 1;       ///< open slots of an exposure, drawn at random: 1..code_slots
    int codes = 1;            ///< exposures of a period; codes x code_slots <= 65535
    bool complement = false;  ///< a second charge store takes the light of the closed slots
};

/// \throws InputError if a number is out of range; with `complement`, `open_slots` is less than
/// `code_slots`.
[[nodiscard]] ExposureSchedule flutter_schedule(const Flutter& flutter, std::uint64_t seed);

}  // namespace stipple
