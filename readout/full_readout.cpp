#include "readout/full_readout.h"

#include <algorithm>
#include <cmath>

#include "readout/slot_readout.h"

namespace stipple {
namespace {

/// `share` of a row's columns in one of `parts` that work side by side, at least one.
int even_part(int cols, int parts, double share) {
    // A product that rounding lifts just above a whole number is that number.
    const double part = share * cols / parts * (1 - 1e-12);
    return std::max(1, static_cast<int>(std::ceil(part)));
}

/// All rows of a window like `load`; dark rows and overhead rows like `full`.
UniformReadout uniform_readout(const ReadoutTiming& timing, int rows, const RowLoad& load,
                               const RowLoad& full) {
    UniformReadout readout;
    readout.channel_columns = load.channel_columns;
    readout.settle = settle_clocks(timing, load.channel_columns);
    readout.convert = convert_clocks(timing, readout.settle, load.conversions);
    readout.transfer = transfer_clocks(timing, load.channel_columns);
    readout.row = row_clocks(timing, readout.convert, readout.transfer);
    const std::int64_t full_row = full_row_clocks(timing, full.columns);
    readout.lead = timing.overhead_clocks + timing.overhead_rows * full_row;
    if (timing.overhead_rows == 0 && timing.law != RowTimeLaw::kSequential)
        readout.lead += readout.convert + timing.blanking_clocks;
    readout.total = readout.lead + timing.dark_rows * full_row + rows * readout.row;
    return readout;
}

}  // namespace

UniformReadout full_readout(const ReadoutTiming& timing, FrameShape shape) {
    check_window(timing, shape);
    const RowLoad full = full_row(timing, shape.cols);
    return uniform_readout(timing, shape.rows, full, full);
}

UniformReadout even_readout(const ReadoutTiming& timing, FrameShape shape, double share) {
    check_window(timing, shape);
    const RowLoad full = full_row(timing, shape.cols);
    RowLoad load = full;
    load.channel_columns = even_part(shape.cols, timing.addressing.channels, share);
    if (timing.adc_skip && timing.columns_per_adc > 1)
        load.conversions = even_part(shape.cols, timing.adcs(), share);
    return uniform_readout(timing, shape.rows, load, full);
}

}  // namespace stipple
