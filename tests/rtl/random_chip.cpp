#include "tests/rtl/random_chip.h"

#include <algorithm>
#include <vector>

#include "tests/readout/gapped_schedule.h"

namespace stipple {

const ChipModel& model(const std::string& name) {
    return *std::ranges::find(chip_models(), name, &ChipModel::name);
}

ReadoutTiming fitted(ReadoutTiming timing, const ChipParameters& size) {
    timing.rows = size.rows;
    timing.cols = size.cols;
    timing.addressing = {.kind = size.group_rows * size.group_cols > 1
                                     ? ColumnAddressing::Kind::kGroup
                                     : ColumnAddressing::Kind::kSkipChannel,
                         .channels = size.channels,
                         .group_cols = size.group_cols,
                         .group_rows = size.group_rows};
    timing.columns_per_adc = size.columns_per_adc;
    return timing;
}

ReadoutTiming random_chip_timing(const ChipParameters& size, Draw& draw) {
    ReadoutTiming timing = fitted(random_timing(draw), size);
    timing.dark_rows = std::min(timing.dark_rows, size.dark_rows);
    timing.bits_per_sample = size.bit_depth;
    timing.exposes_while_reading = draw(0, 3) > 0;
    if (timing.rot_clocks == 0 && timing.adc_clocks == 0 &&
        (timing.settle_clocks.empty() || timing.settle_clocks.front() == 0))
        timing.rot_clocks = 1;
    const int all = size.cols / size.channels;
    if (!timing.row_table_cols.empty()) {
        timing.clocks_per_column = 1;
        timing.row_table_cols = {size.channels, 2 * size.channels, size.cols};
        timing.row_table_clocks = {1, draw(2, 4), draw(all, all + 3)};
        if (all <= 2) timing.row_table_cols = timing.row_table_clocks = {};
    }
    return timing;
}

ExposureSchedule schedule_for(const ChipParameters& size, std::uint32_t seed, Draw& draw) {
    const int rows = draw(0, 1) == 0 ? size.tile_rows : 4;
    const int cols = draw(0, 1) == 0 ? size.tile_cols : 4;
    if (size.pixel_bits > 1 && draw(0, 2) == 0) return random_frames(draw);
    if (size.pixel_bits > 2 && draw(0, 1) == 0)
        return interleaved_schedule(rows, cols, draw(1, 5), seed);
    if (size.pixel_bits > 1 && draw(0, 1) == 0)
        return gapped_schedule(rows, cols, draw(13, size.depth), seed);
    return random_schedule(rows, cols, std::vector{1, draw(2, 3), draw(4, 8)}, seed);
}

}  // namespace stipple
