#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry.h"

namespace stipple {

/// A range of rows, columns or slots: [begin, end) is decoded, [core_begin, core_end) is kept. The
/// rest is the halo, where the edge of the block causes errors.
struct HaloRange {
    std::int64_t begin = 0;
    std::int64_t core_begin = 0;
    std::int64_t core_end = 0;
    std::int64_t end = 0;
};

/// Slots of a block's core; minimum and maximum of its halo on each side; and the longest remainder
/// that belongs to the last block and does not form a block of its own.
inline constexpr std::int64_t kCoreSlots = 48;
inline constexpr std::int64_t kHaloSlots = 8;
inline constexpr std::int64_t kMaxHaloSlots = 32;
inline constexpr std::int64_t kRemainderSlots = 16;

/// The halo that contains all exposures of a block's core completely, up to kMaxHaloSlots.
[[nodiscard]] std::int64_t halo_slots(int longest_span_slots);

/// The block whose core begins at `core_begin`, of a stream with `slots` slots. If the stream is
/// still growing, `slots` is the number known so far; it must exceed core_begin + kCoreSlots +
/// kRemainderSlots and be at least core_begin + kCoreSlots + halo.
[[nodiscard]] HaloRange slot_range(std::int64_t core_begin, std::int64_t slots,
                                   std::int64_t halo = kHaloSlots);

/// The number of blocks of a stream with `slots` slots, which are decoded independently.
[[nodiscard]] std::int64_t block_count(std::int64_t slots);

/// The block whose core has a slot of a stream with `slots` slots.
[[nodiscard]] std::int64_t block_of(std::int64_t slot, std::int64_t slots);

/// The first slot of the core of block `number`.
[[nodiscard]] inline std::int64_t block_begin(std::int64_t number) {
    return number * kCoreSlots;
}

/// Tiles of a frame, in rows and columns.
struct Tile {
    HaloRange rows;
    HaloRange cols;
};

inline constexpr std::int64_t kMaxCoreSites = std::int64_t{1} << 20;

/// The smallest number of equal tiles whose cores have at most `max_core_sites` sites. Depends on
/// the shape only.
[[nodiscard]] std::vector<Tile> frame_tiles(FrameShape shape,
                                            std::int64_t max_core_sites = kMaxCoreSites);

}  // namespace stipple
