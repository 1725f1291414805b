#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/exposure_schedule.h"

namespace stipple {

/// Every pixel of the array exposes `open_slots` slots together, every `period_slots` slots: a
/// conventional camera. \throws InputError unless 1 <= open_slots <= 64, open_slots <= period.
[[nodiscard]] ExposureSchedule full_schedule(int open_slots, int period_slots);

/// Pixels along the sides of such a tile and lengths of a pixel: 2^24 exposures, a stream's most.
inline constexpr int kMaxTiledSide = 256;
inline constexpr std::size_t kMaxTiledLengths = 255;

/// A seeded tile in which every pixel repeats its own permutation of `exposure_slots` without
/// gaps, and the number of pixels due per slot is as even as possible over the period.
/// \throws InputError if a length is outside 1..64 or the tile is empty or beyond 256 x 256.
[[nodiscard]] ExposureSchedule tiled_schedule(int tile_rows, int tile_cols,
                                              std::span<const int> exposure_slots,
                                              std::uint64_t seed);

}  // namespace stipple
