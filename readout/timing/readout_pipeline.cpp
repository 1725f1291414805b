#include "readout/timing/readout_pipeline.h"

#include <algorithm>

namespace stipple {

void ReadoutPipeline::begin_slot(std::int64_t cycle, std::int64_t full_row_clocks,
                                 int settle) noexcept {
    settle_ = settle;
    begin_ = cycle;
    // Overhead rows pass through the pipeline as full rows do; the first row is selected beside the
    // transfer of the last of them.
    first_transfer_ = cycle + timing_.overhead_clocks + timing_.overhead_rows * full_row_clocks;
    first_select_ = first_transfer_;
    if (timing_.overhead_rows > 0 && !is_sequential()) first_select_ -= full_row_clocks;
    link_free_ = cycle;
    any_row_ = false;

    // Stands for the rows before the first one; its end lets that one begin at once.
    const int none = -timing_.dark_rows - 1;
    const std::int64_t long_ago = cycle - timing_.blanking_clocks;
    newest_ = {none, true, true, true, long_ago, 0, long_ago, long_ago, long_ago};
    older_ = newest_;
}

std::int64_t ReadoutPipeline::earliest_select(int row) const noexcept {
    if (row <= newest_.row || !newest_.converted) return kNever;
    const Row& before = is_sequential() ? newest_ : older_;  // whose latch this row takes
    if (!before.transferred) return kNever;
    const std::int64_t rest = timing_.blanking_clocks;
    if (is_sequential()) return std::max(first_select_, before.transfer_end + rest);
    // The converters are free, and so is the latch that takes the row after them.
    return std::max({first_select_, newest_.convert_end + rest, before.transfer_end + rest});
}

std::int64_t ReadoutPipeline::earliest_transfer(int row) const noexcept {
    const bool is_newest = row == newest_.row;
    if (!is_newest && row != older_.row) return kNever;
    const Row& it = is_newest ? newest_ : older_;
    if (!any_row_ || !it.converted || it.transferred) return kNever;
    if (is_newest && !older_.transferred) return kNever;
    if (is_sequential()) return it.convert_end;
    // The link is free, and the row is in its latch.
    return std::max({first_transfer_, link_free_, it.convert_end + timing_.blanking_clocks});
}

std::int64_t ReadoutPipeline::earliest_cycle(const ReadoutCommand& command) const noexcept {
    switch (command.kind) {
        case ReadoutCommand::Kind::kSelect:
            return earliest_select(command.row);
        case ReadoutCommand::Kind::kConvert:
            return any_row_ && command.row == newest_.row && !newest_.converted ? newest_.select_end
                                                                                : kNever;
        case ReadoutCommand::Kind::kTransfer:
            return earliest_transfer(command.row);
    }
    return kNever;
}

std::int64_t ReadoutPipeline::clocks(const ReadoutCommand& command) const noexcept {
    switch (command.kind) {
        case ReadoutCommand::Kind::kSelect:
            return timing_.rot_clocks +
                   std::int64_t{timing_.skip_row_clocks} * (command.row - newest_.row - 1);
        case ReadoutCommand::Kind::kConvert:
            return convert_clocks(timing_, settle_, command.count) - timing_.rot_clocks;
        case ReadoutCommand::Kind::kTransfer:
            return transfer_clocks(timing_, command.count);
    }
    return 0;
}

bool ReadoutPipeline::issue(const ReadoutCommand& command, std::int64_t cycle) noexcept {
    const std::int64_t earliest = earliest_cycle(command);
    if (earliest == kNever || cycle < earliest) return false;

    const std::int64_t end = cycle + clocks(command);
    switch (command.kind) {
        case ReadoutCommand::Kind::kSelect:  // the row before moves on to the latch
            older_ = newest_;
            newest_ = {.row = command.row, .selected = true, .select_end = end};
            any_row_ = true;
            break;
        case ReadoutCommand::Kind::kConvert:
            newest_.converted = true;
            newest_.convert_clocks = convert_clocks(timing_, settle_, command.count);
            newest_.convert_end = end;
            break;
        case ReadoutCommand::Kind::kTransfer: {
            Row& it = command.row == newest_.row ? newest_ : older_;
            it.transferred = true;
            it.transfer_begin = cycle;
            it.transfer_end = end;
            link_free_ = end + timing_.blanking_clocks;
            break;
        }
    }
    return true;
}

std::int64_t ReadoutPipeline::end_cycle() const noexcept {
    if (!any_row_) return begin_;
    std::int64_t end = newest_.transfer_end;
    if (!is_sequential()) end = std::max(end, newest_.transfer_begin + newest_.convert_clocks);
    return end + timing_.blanking_clocks;
}

}  // namespace stipple
