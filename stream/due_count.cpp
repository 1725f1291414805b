#include "stream/due_count.h"

#include <algorithm>
#include <span>

#include "core/index.h"
#include "stream/schedule_switch.h"

namespace stipple {
namespace {

constexpr std::int64_t kMaxSpanSlots = 64;

using DuePixels = std::span<const DuePixel>;

/// Those whose exposure began in slot 0 or later.
std::size_t count_begun(DuePixels due, std::int64_t slot) {
    if (slot >= kMaxSpanSlots) return due.size();
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

DueCounts::DueCounts(int rows, int period_slots)
    : rows_(rows),
      period_slots_(period_slots),
      steady_(index(rows) * index(period_slots)),
      absent_(index(rows) * index(std::min<std::int64_t>(period_slots, kMaxSpanSlots))) {}

void DueCounts::add(int row, std::span<const Exposure> of_pixel) {
    for (const Exposure& exposure : of_pixel) {
        const int span = exposure.span_slots();
        const auto phase = (static_cast<int>(exposure.first_slot) + span - 1) % period_slots_;
        const std::size_t at = index(phase) * index(rows_) + index(row);
        ++steady_[at];
        if (span > phase + 1) ++absent_[at];  // no exposure is longer than the period
    }
}

std::size_t DueCounts::due(std::int64_t slot, int row) const {
    const std::size_t due = steady_[index(slot % period_slots_) * index(rows_) + index(row)];
    const std::size_t at = index(slot) * index(rows_) + index(row);
    return slot < period_slots_ && at < absent_.size() ? due - absent_[at] : due;
}

bool matches_counts(const DueCounts& counts, std::int64_t slot, RowBand band, std::size_t planes,
                    std::size_t samples) {
    std::size_t due_samples = 0;
    for (int i = 0; i < band.rows && due_samples <= samples; ++i)
        due_samples += planes * counts.due(slot, band.first_row + i);
    return due_samples == samples;
}

bool matches_schedule(const StreamHeader& stream, std::int64_t slot, RowBand band,
                      std::size_t samples) {
    const SchedulePart part = schedule_at(stream, slot);
    const ExposureSchedule& schedule = *part.schedule;
    slot = readout_slot(part, slot);
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
