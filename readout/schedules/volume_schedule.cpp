#include "readout/schedules/volume_schedule.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "readout/schedules/tile_list.h"

namespace stipple {
namespace {

constexpr double kWhite = 255;  // of masks that are stored as images

struct TilePixel {
    int row;
    int col;
};

/// Masks, and what their open slots are marked by.
struct Masks {
    const NpyVolume& volume;
    double open;
    std::string_view where;
};

bool is_open(const Masks& masks, int slot, TilePixel pixel) {
    const double value = masks.volume.at(slot, pixel.row, pixel.col);
    if (value == 0 || value == masks.open) return value == masks.open;
    throw InputError(masks.where, fmt::format("pixel ({}, {}) slot {}: {} is neither 0 nor {}",
                                              pixel.row, pixel.col, slot, value, masks.open));
}

void add_mask(const Masks& masks, TilePixel pixel, TileList& list) {
    int first = -1;
    std::uint64_t mask = 0;
    for (int slot = 0; slot < masks.volume.layers; ++slot) {
        if (!is_open(masks, slot, pixel)) continue;
        if (first < 0) first = slot;
        if (slot - first >= kMaxExposureSlots)
            throw InputError(
                masks.where,
                fmt::format("pixel ({}, {}) slot {}: the exposure from slot {} on spans "
                            "more than {} slots",
                            pixel.row, pixel.col, slot, first, kMaxExposureSlots));
        mask |= std::uint64_t{1} << static_cast<unsigned>(slot - first);
    }
    if (first >= 0) list.add(static_cast<std::uint32_t>(first), mask);
    list.end_pixel();
}

int length_at(const NpyVolume& lengths, int layer, TilePixel pixel, std::string_view where) {
    const double value = lengths.at(layer, pixel.row, pixel.col);
    if (value >= 0 && value <= kMaxExposureSlots && value == static_cast<int>(value))
        return static_cast<int>(value);
    throw InputError(where,
                     fmt::format("pixel ({}, {}) exposure {}: {} is no whole number of slots "
                                 "from 0 to {}",
                                 pixel.row, pixel.col, layer, value, kMaxExposureSlots));
}

template <typename Visit>
void for_each_pixel(const NpyVolume& volume, const Visit& visit) {
    for (int row = 0; row < volume.rows; ++row)
        for (int col = 0; col < volume.cols; ++col) visit(TilePixel{row, col});
}

/// The largest sum of a pixel, or `period_slots` if no sum is longer.
int checked_period(const NpyVolume& lengths, int period_slots, std::string_view where) {
    std::int64_t longest = 1;
    for_each_pixel(lengths, [&](TilePixel pixel) {
        std::int64_t sum = 0;
        for (int layer = 0; layer < lengths.layers; ++layer) {
            sum += length_at(lengths, layer, pixel, where);
            const int max_slots = period_slots > 0 ? period_slots : kMaxPeriodSlots;
            if (sum > max_slots)
                throw InputError(where,
                                 fmt::format("pixel ({}, {}) exposure {}: ends after {} slots;"
                                             " the period is {}",
                                             pixel.row, pixel.col, layer, sum, max_slots));
        }
        longest = std::max(longest, sum);
    });
    return period_slots > 0 ? period_slots : static_cast<int>(longest);
}

}  // namespace

ExposureSchedule mask_schedule(const NpyVolume& masks, std::string_view where) {
    TileList list(masks.rows, masks.cols, masks.layers);
    const bool white = std::ranges::find(masks.values, kWhite) != masks.values.end();
    const Masks marked{masks, white ? kWhite : 1, where};
    for_each_pixel(masks, [&](TilePixel pixel) { add_mask(marked, pixel, list); });
    return std::move(list).schedule();
}

ExposureSchedule lengths_schedule(const NpyVolume& lengths, int period_slots,
                                  std::string_view where) {
    TileList list(lengths.rows, lengths.cols, checked_period(lengths, period_slots, where));
    for_each_pixel(lengths, [&](TilePixel pixel) {
        std::uint32_t slot = 0;
        for (int layer = 0; layer < lengths.layers; ++layer) {
            const int length = length_at(lengths, layer, pixel, where);
            if (length > 0) list.add_open(slot, length);
            slot += static_cast<std::uint32_t>(length);
        }
        list.end_pixel();
    });
    return std::move(list).schedule();
}

}  // namespace stipple
