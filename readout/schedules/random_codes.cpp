#include "readout/schedules/random_codes.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "readout/schedules/draws.h"
#include "readout/schedules/schedule_builder.h"

namespace stipple {
namespace {

void check_tile(int rows, int cols) {
    if (rows < 1 || cols < 1 || rows > kMaxTileSide || cols > kMaxTileSide)
        throw InputError("random codes",
                         fmt::format("tile {} x {} is outside 1..{} rows and columns", rows, cols,
                                     kMaxTileSide));
}

/// `open` of `slots` bits set, all choices equally likely.
std::uint64_t draw_mask(Draws& draws, int slots, int open) {
    std::uint64_t mask = 0;
    int needed = open;
    for (int slot = 0; slot < slots; ++slot)
        if (static_cast<int>(draws.below(static_cast<std::size_t>(slots - slot))) < needed) {
            mask |= std::uint64_t{1} << static_cast<unsigned>(slot);
            --needed;
        }
    return mask;
}

void add_mask(ScheduleBuilder& list, int begin, std::uint64_t mask) {
    if (mask == 0) return;
    const int closed = std::countr_zero(mask);
    list.add(static_cast<std::uint32_t>(begin + closed), mask >> static_cast<unsigned>(closed));
}

}  // namespace

ExposureSchedule scattered_schedule(const Scatter& scatter, std::span<const int> exposure_slots,
                                    std::uint64_t seed) {
    constexpr int kClosed = 0;  // an item of one slot
    check_tile(scatter.tile_rows, scatter.tile_cols);
    for (const int length : exposure_slots)
        if (length < 1 || length > kMaxExposureSlots)
            throw InputError("scattered exposures",
                             fmt::format("exposure of {} slots is outside 1..64", length));
    const auto open =
        std::accumulate(exposure_slots.begin(), exposure_slots.end(), std::int64_t{0});
    if (open < 1 || open > scatter.period_slots || scatter.period_slots > kMaxPeriodSlots)
        throw InputError("scattered exposures",
                         fmt::format("exposures of {} slots in a period of {}: needs 1 or more, a "
                                     "period not shorter, and at most {}",
                                     open, scatter.period_slots, kMaxPeriodSlots));
    std::vector<int> items(exposure_slots.begin(), exposure_slots.end());
    items.resize(items.size() + static_cast<std::size_t>(scatter.period_slots - open), kClosed);
    ScheduleBuilder list(scatter.tile_rows, scatter.tile_cols, scatter.period_slots);
    Draws draws(seed, DrawPlane::kScattered);
    for (int pixel = 0; pixel < scatter.tile_rows * scatter.tile_cols; ++pixel) {
        shuffle(items, draws);
        const auto period = static_cast<std::size_t>(scatter.period_slots);
        std::uint32_t slot = scatter.wrap ? draws.below(period) : 0;
        for (const int length : items) {
            if (length != kClosed) list.add_open(slot, length);
            slot += static_cast<std::uint32_t>(std::max(length, 1));
        }
        list.end_pixel();
    }
    return std::move(list).schedule();
}

ExposureSchedule flutter_schedule(const Flutter& flutter, std::uint64_t seed) {
    check_tile(flutter.tile_rows, flutter.tile_cols);
    const int max_open = flutter.code_slots - (flutter.complement ? 1 : 0);
    if (flutter.code_slots < 1 || flutter.code_slots > kMaxExposureSlots ||
        flutter.open_slots < 1 || flutter.open_slots > max_open || flutter.codes < 1 ||
        flutter.codes > kMaxPeriodSlots / flutter.code_slots)
        throw InputError(
            "flutter", fmt::format("{} codes of {} slots with {} open{}: needs 1 to {} slots, 1 "
                                   "to {} of them open, and at most {} slots in all",
                                   flutter.codes, flutter.code_slots, flutter.open_slots,
                                   flutter.complement ? " and a complement" : "", kMaxExposureSlots,
                                   max_open, kMaxPeriodSlots));
    ScheduleBuilder list(flutter.tile_rows, flutter.tile_cols, flutter.codes * flutter.code_slots);
    Draws draws(seed, DrawPlane::kFlutter);
    const std::uint64_t all = open_without_gap(flutter.code_slots);
    for (int pixel = 0; pixel < flutter.tile_rows * flutter.tile_cols; ++pixel) {
        for (int code = 0; code < flutter.codes; ++code) {
            const auto mask = draw_mask(draws, flutter.code_slots, flutter.open_slots);
            add_mask(list, code * flutter.code_slots, mask);
            if (flutter.complement) add_mask(list, code * flutter.code_slots, all & ~mask);
        }
        list.end_pixel();
    }
    return std::move(list).schedule();
}

}  // namespace stipple
