#include "readout/schedules/volume_schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/index.h"
#include "readout/schedules/schedule_builder.h"

namespace stipple {
namespace {

struct TilePixel {
    int row;
    int col;
};

/// Masks, and the value that is weight 1.
struct Masks {
    const NpyVolume& volume;
    double white;
    std::string_view where;
};

/// A weight below the least that is a weight counts as 0.
float weight_at(const Masks& masks, int slot, TilePixel pixel) {
    const double weight = masks.volume.at(slot, pixel.row, pixel.col) / masks.white;
    if (!(weight >= 0 && weight <= static_cast<double>(kMaxSlotWeight)))
        throw InputError(
            masks.where,
            fmt::format("pixel ({}, {}) slot {}: {} is not a weight: it is outside 0..{}",
                        pixel.row, pixel.col, slot, masks.volume.at(slot, pixel.row, pixel.col),
                        masks.white * static_cast<double>(kMaxSlotWeight)));
    const auto rounded = static_cast<float>(weight);
    return rounded < kMinSlotWeight ? 0 : rounded;
}

/// Adds the exposure of a pixel, and its weights to `weights` of order (slot, row, col).
void add_mask(const Masks& masks, TilePixel pixel, ScheduleBuilder& list,
              std::vector<float>& weights) {
    const NpyVolume& volume = masks.volume;
    int first = -1;
    std::uint64_t mask = 0;
    for (int slot = 0; slot < volume.layers; ++slot) {
        const float weight = weight_at(masks, slot, pixel);
        weights[row_major(slot * volume.rows + pixel.row, pixel.col, volume.cols)] = weight;
        if (weight == 0) continue;
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
                     fmt::format("pixel ({}, {}) exposure {}: {} is not a whole number of slots "
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

double white_of(const NpyVolume& masks) {
    double most = 0;
    for (const double value : masks.values) {
        if (value != std::round(value) && value >= 0) return 1;
        most = std::max(most, value);
    }
    for (const double white : {1.0, 255.0, 65535.0})
        if (most <= white) return white;
    return 1;
}

ExposureSchedule mask_schedule(const NpyVolume& masks, std::string_view where, double white) {
    ScheduleBuilder list(masks.rows, masks.cols, masks.layers);
    const Masks marked{masks, white > 0 ? white : white_of(masks), where};
    std::vector<float> weights(masks.values.size());
    for_each_pixel(masks, [&](TilePixel pixel) { add_mask(marked, pixel, list, weights); });
    ExposureSchedule schedule = std::move(list).schedule();
    if (schedule.longest_span_slots() == 0)
        throw InputError(where, "all weights are 0; a measurement needs an open slot");
    schedule.set_weights(std::move(weights));
    return schedule;
}

ExposureSchedule lengths_schedule(const NpyVolume& lengths, int period_slots,
                                  std::string_view where) {
    ScheduleBuilder list(lengths.rows, lengths.cols, checked_period(lengths, period_slots, where));
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
