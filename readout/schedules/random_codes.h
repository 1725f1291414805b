#pragma once

#include <cstdint>
#include <span>

#include "core/exposure_schedule.h"

namespace stipple {

/// A tile in which every pixel repeats exposures of the lengths `exposure_slots`, in random order
/// at random places of the period, anywhere (`wrap`) or so that none goes beyond its end. All
/// places are equally likely. \throws InputError if a length is outside 1..64, or all together are
/// longer than the period.
struct Scatter {
    int tile_rows = 1;
    int tile_cols = 1;
    int period_slots = 1;
    bool wrap = true;
};
[[nodiscard]] ExposureSchedule scattered_schedule(const Scatter& scatter,
                                                  std::span<const int> exposure_slots,
                                                  std::uint64_t seed);

/// A tile in which every pixel repeats `codes` exposures of `code_slots` slots, of which
/// `open_slots`, drawn at random for each, are open (flutter). With `complement` a second charge
/// store takes the light of the others. \throws InputError unless 1 <= open_slots <= code_slots <=
/// 64 (less than code_slots with complement) and codes x code_slots <= 65535.
struct Flutter {
    int tile_rows = 1;
    int tile_cols = 1;
    int code_slots = 1;
    int open_slots = 1;
    int codes = 1;
    bool complement = false;
};
[[nodiscard]] ExposureSchedule flutter_schedule(const Flutter& flutter, std::uint64_t seed);

}  // namespace stipple
