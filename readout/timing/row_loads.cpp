#include "readout/timing/row_loads.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/index.h"

namespace stipple {
namespace {

int divided_up(int value, int by) {
    return (value + by - 1) / by;
}

bool in_groups(const ReadoutTiming& timing) {
    return timing.addressing.kind == ColumnAddressing::Kind::kGroup;
}

int group_cols(const ReadoutTiming& timing) {
    return in_groups(timing) ? timing.addressing.group_cols : 1;
}

std::vector<std::uint16_t> numbered(int cols, int modulus) {
    std::vector<std::uint16_t> numbers(index(cols));
    for (int col = 0; col < cols; ++col)
        numbers[index(col)] = static_cast<std::uint16_t>(col % modulus);
    return numbers;
}

bool adcs_skip(const ReadoutTiming& timing) {
    return timing.adc_skip && timing.columns_per_adc > 1;
}

}  // namespace

void check_window(const ReadoutTiming& timing, FrameShape shape) {
    if (shape.rows >= 1 && shape.cols >= 1 && shape.rows <= timing.rows &&
        shape.cols <= timing.cols)
        return;
    throw InputError("readout timing",
                     fmt::format("{} x {} pixels (width x height) are more than the array of {} x "
                                 "{}, timing.cols x timing.rows; ",
                                 shape.cols, shape.rows, timing.cols, timing.rows) +
                         Parameter{"crop"} + " takes a part of footage");
}

RowLoad full_row(const ReadoutTiming& timing, int cols) {
    return {.row = 0,
            .due = 0,
            .columns = cols,
            .channel_columns = divided_up(cols, timing.addressing.channels),
            .conversions =
                adcs_skip(timing) ? divided_up(cols, timing.adcs()) : timing.columns_per_adc};
}

RowLoads::RowLoads(const ReadoutTiming& timing, const ExposureSchedule& schedule, FrameShape shape)
    : timing_(timing),
      schedule_(schedule),
      shape_(shape),
      block_rows_(in_groups(timing) ? timing.addressing.group_rows : 1),
      count_adcs_(adcs_skip(timing)) {
    check_window(timing, shape);
    channel_ = numbered(shape.cols, timing.addressing.channels);
    if (count_adcs_) adc_ = numbered(shape.cols, timing.adcs());
    is_marked_.assign(index(divided_up(shape.cols, group_cols(timing))), 0);
    due_.resize(index(block_rows_));
    by_channel_.resize(index(timing.addressing.channels));
    by_adc_.resize(count_adcs_ ? index(timing.adcs()) : 0);
}

/// Lists in `marked_` the groups with pixels due in the block's rows, and counts those in `due_`.
void RowLoads::mark_block(std::int64_t slot, int first_row) {
    const int width = group_cols(timing_);
    const int end_row = std::min(first_row + block_rows_, shape_.rows);
    marked_.clear();
    for (int row = first_row; row < end_row; ++row) {
        int due = 0;
        for_each_readout(schedule_, slot, row, shape_.cols, [&](int col, int) {
            ++due;
            std::uint8_t& is_marked = is_marked_[index(col / width)];
            if (is_marked != 0) return;
            is_marked = 1;
            marked_.push_back(static_cast<std::uint16_t>(col / width * width));
        });
        due_[index(row - first_row)] = due;
    }
    for (const std::uint16_t col : marked_) is_marked_[index(col / width)] = 0;
}

RowLoad RowLoads::count_marked() {
    std::ranges::fill(by_channel_, 0);
    std::ranges::fill(by_adc_, 0);
    RowLoad load;
    const int width = group_cols(timing_);
    for (const std::uint16_t first : marked_) {
        const int end = std::min(first + width, shape_.cols);
        load.columns += end - first;
        for (int col = first; col < end; ++col) {
            ++by_channel_[channel_[index(col)]];
            if (count_adcs_) ++by_adc_[adc_[index(col)]];
        }
    }
    load.channel_columns = std::ranges::max(by_channel_);
    load.conversions = count_adcs_ ? std::ranges::max(by_adc_) : timing_.columns_per_adc;
    return load;
}

bool RowLoads::is_due(std::int64_t slot, int row) const {
    const auto phase = static_cast<int>(slot % schedule_.period_slots());
    const int first_row = row - row % block_rows_;
    for (int i = first_row; i < std::min(first_row + block_rows_, shape_.rows); ++i)
        if (std::ranges::any_of(schedule_.due(phase, i % schedule_.tile_rows()),
                                [&](const DuePixel& pixel) {
                                    return pixel.col < shape_.cols && pixel.span_slots <= slot + 1;
                                }))
            return true;
    return false;
}

int RowLoads::due_again_slots(std::int64_t slot, int row) const {
    int slots = 1;
    while (!is_due(slot + slots, row)) ++slots;  // at the latest after a period
    return slots;
}

void RowLoads::list(std::int64_t slot, std::vector<RowLoad>& loads) {
    loads.clear();
    RowLoad dark = full_row(timing_, shape_.cols);
    for (dark.row = -timing_.dark_rows; dark.row < 0; ++dark.row) loads.push_back(dark);
    for (int first_row = 0; first_row < shape_.rows; first_row += block_rows_) {
        mark_block(slot, first_row);
        if (marked_.empty()) continue;
        RowLoad load = count_marked();
        const int end_row = std::min(first_row + block_rows_, shape_.rows);
        for (load.row = first_row; load.row < end_row; ++load.row) {
            load.due = due_[index(load.row - first_row)];
            loads.push_back(load);
        }
    }
    if (loads.size() == index(timing_.dark_rows)) loads.clear();
}

std::span<const int> RowLoads::channel_columns(std::int64_t slot, int row) {
    if (row < 0) {
        std::ranges::fill(by_channel_, 0);
        for (const std::uint16_t channel : channel_) ++by_channel_[channel];
        return by_channel_;
    }
    mark_block(slot, row - row % block_rows_);
    static_cast<void>(count_marked());
    return by_channel_;
}

}  // namespace stipple
