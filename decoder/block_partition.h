#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry.h"

namespace stipple {

/// A stretch of rows, columns or slots: [begin, end) is decoded, [core_begin, core_end) is kept.
/// What lies between is the halo, in which the edge of the block does harm.
struct HaloRange {
    std::int64_t begin = 0;
    std::int64_t core_begin = 0;
    std::int64_t core_end = 0;
    std::int64_t end = 0;
};

/// Slots of a block's core, of its halo on each side, at least and at most, and the longest rest
/// that the last block takes along instead of leaving it to a block of its own.
inline constexpr std::int64_t kCoreSlots = 48;
inline constexpr std::int64_t kHaloSlots = 8;
inline constexpr std::int64_t kMaxHaloSlots = 32;
inline constexpr std::int64_t kRestSlots = 16;

/// The halo that holds the whole of the exposures of a block's core, as far as a halo may grow.
[[nodiscard]] std::int64_t halo_slots(int longest_span_slots);

/// The block of slots whose core begins at `core_begin`, of a recording that has `slots` slots; if
/// it may go on, `slots` is what is known so far, more than core_begin + kCoreSlots + kRestSlots
/// and no less than core_begin + kCoreSlots + halo.
[[nodiscard]] HaloRange slot_range(std::int64_t core_begin, std::int64_t slots,
                                   std::int64_t halo = kHaloSlots);

/// Tiles of a frame, in rows and columns.
struct Tile {
    HaloRange rows;
    HaloRange cols;
};

inline constexpr std::int64_t kMaxCoreSites = std::int64_t{1} << 20;

/// Cuts a frame into the fewest equal tiles with at most so many sites in their cores; it depends
/// on the shape only.
[[nodiscard]] std::vector<Tile> frame_tiles(FrameShape shape,
                                            std::int64_t max_core_sites = kMaxCoreSites);

}  // namespace stipple
