#include "stream/due_count.h"

#include <algorithm>
#include <span>

namespace stipple {
namespace {

using DuePixels = std::span<const DuePixel>;

/// Those whose exposure began in slot 0 or later.
std::size_t count_begun(DuePixels due, std::int64_t slot) {
    constexpr std::int64_t kLongestSpanSlots = 64;
    if (slot >= kLongestSpanSlots) return due.size();
    return static_cast<std::size_t>(std::ranges::count_if(
        due, [slot](const DuePixel& pixel) { return pixel.span_slots <= slot + 1; }));
}

/// Those of the tile's first `cols` columns.
DuePixels left_part(DuePixels due, int cols) {
    const auto end = std::ranges::partition_point(
        due, [cols](const DuePixel& pixel) { return pixel.col < cols; });
    return due.first(static_cast<std::size_t>(end - due.begin()));
}

}  // namespace

bool matches_schedule(const StreamHeader& stream, std::int64_t slot, RowBand band,
                      std::size_t samples) {
    const ExposureSchedule& schedule = stream.schedule;
    const auto phase = static_cast<int>(slot % schedule.period_slots());
    const auto planes = static_cast<std::size_t>(stream.shape.planes);
    const auto whole_tiles = static_cast<std::size_t>(stream.shape.cols / schedule.tile_cols());
    const int rest_cols = stream.shape.cols % schedule.tile_cols();
    std::size_t due_samples = 0;
    for (int i = 0; i < band.rows && due_samples <= samples; ++i) {
        const auto due = schedule.due(phase, (band.first_row + i) % schedule.tile_rows());
        due_samples += planes * whole_tiles * count_begun(due, slot);
        due_samples += planes * count_begun(left_part(due, rest_cols), slot);
    }
    return due_samples == samples;
}

}  // namespace stipple
