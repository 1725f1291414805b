#include "readout/timing/slot_readout.h"

#include <algorithm>
#include <cassert>

#include "readout/timing/readout_pipeline.h"

namespace stipple {
namespace {

using Kind = ReadoutCommand::Kind;

/// Issues a command as early as possible; returns when.
std::int64_t issue_early(ReadoutPipeline& pipeline, const ReadoutCommand& command) {
    const std::int64_t cycle = pipeline.earliest_cycle(command);
    [[maybe_unused]] const bool issued = pipeline.issue(command, cycle);
    assert(issued);
    return cycle;
}

}  // namespace

int settle_of(const ReadoutTiming& timing, std::span<const RowLoad> loads) {
    if (loads.empty()) return 0;
    const auto least = std::ranges::min_element(loads, {}, &RowLoad::channel_columns);
    return settle_clocks(timing, least->channel_columns);
}

std::int64_t full_row_clocks(const ReadoutTiming& timing, int cols) {
    const RowLoad full = full_row(timing, cols);
    const int settle = settle_clocks(timing, full.channel_columns);
    return row_clocks(timing, convert_clocks(timing, settle, full.conversions),
                      transfer_clocks(timing, full.channel_columns));
}

SlotTimes read_slot(const ReadoutTiming& timing, int cols, std::span<const RowLoad> loads,
                    std::int64_t begin) {
    SlotTimes times{.settle = settle_of(timing, loads), .begin = begin, .end = begin, .rows = {}};
    ReadoutPipeline pipeline(timing);
    pipeline.begin_slot(begin, full_row_clocks(timing, cols), times.settle);
    times.rows.reserve(loads.size());
    for (const RowLoad& load : loads) {
        const ReadoutCommand convert{Kind::kConvert, load.row, load.conversions};
        const ReadoutCommand transfer{Kind::kTransfer, load.row, load.channel_columns};
        RowTimes& row = times.rows.emplace_back(RowTimes{.load = load});
        row.select = issue_early(pipeline, {Kind::kSelect, load.row, 0});
        row.convert = issue_early(pipeline, convert);
        row.convert_end = row.convert + pipeline.clocks(convert);
        row.transfer = issue_early(pipeline, transfer);
        row.transfer_end = row.transfer + pipeline.clocks(transfer);
        row.frame_end = pipeline.end_cycle();
        times.end = row.frame_end;
    }
    return times;
}

}  // namespace stipple
