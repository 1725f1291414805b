#include "decoder/block_partition.h"

#include <algorithm>

namespace stipple {
namespace {

constexpr std::int64_t kHaloPixels = 32;

HaloRange part(std::int64_t length, std::int64_t i, std::int64_t parts) {
    const std::int64_t begin = length * i / parts;
    const std::int64_t end = length * (i + 1) / parts;
    return {.begin = std::max<std::int64_t>(begin - kHaloPixels, 0),
            .core_begin = begin,
            .core_end = end,
            .end = std::min(end + kHaloPixels, length)};
}

}  // namespace

std::int64_t halo_slots(int longest_span_slots) {
    return std::clamp<std::int64_t>(longest_span_slots - 1, kHaloSlots, kMaxHaloSlots);
}

HaloRange slot_range(std::int64_t core_begin, std::int64_t slots, std::int64_t halo) {
    const bool last = slots - core_begin <= kCoreSlots + kRemainderSlots;
    const std::int64_t core_end = last ? slots : core_begin + kCoreSlots;
    return {.begin = std::max<std::int64_t>(core_begin - halo, 0),
            .core_begin = core_begin,
            .core_end = core_end,
            .end = std::min(core_end + halo, slots)};
}

std::int64_t block_count(std::int64_t slots) {
    return slots <= 0 ? 0 : 1 + std::max<std::int64_t>(slots - kRemainderSlots - 1, 0) / kCoreSlots;
}

std::int64_t block_of(std::int64_t slot, std::int64_t slots) {
    return std::min(slot / kCoreSlots, std::max<std::int64_t>(block_count(slots), 1) - 1);
}

std::vector<Tile> frame_tiles(FrameShape shape, std::int64_t max_core_sites) {
    std::int64_t down = 1;
    std::int64_t across = 1;
    const auto ceil_div = [](std::int64_t a, std::int64_t b) { return (a + b - 1) / b; };
    const auto tile_rows = [&] { return ceil_div(shape.rows, down); };
    const auto tile_cols = [&] { return ceil_div(shape.cols, across); };
    while (tile_rows() * tile_cols() * shape.planes > max_core_sites)
        ++(tile_rows() > tile_cols() ? down : across);
    std::vector<Tile> tiles;
    for (std::int64_t row = 0; row < down; ++row)
        for (std::int64_t col = 0; col < across; ++col)
            tiles.push_back({part(shape.rows, row, down), part(shape.cols, col, across)});
    return tiles;
}

}  // namespace stipple
