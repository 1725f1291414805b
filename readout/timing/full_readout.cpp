#include "readout/timing/full_readout.h"

#include <algorithm>
#include <vector>

#include "readout/timing/slot_readout.h"

namespace stipple {
namespace {

/// What comes before the rows: overhead, and the conversion of the first row where conversion and
/// transfer do not take turns.
std::int64_t lead_clocks(const ReadoutTiming& timing, std::int64_t full_row,
                         std::int64_t first_convert) {
    const std::int64_t overhead = timing.overhead_clocks + timing.overhead_rows * full_row;
    if (timing.overhead_rows > 0 || timing.row_timing == RowTiming::kSequential) return overhead;
    return overhead + first_convert + timing.blanking_clocks;
}

struct Point {
    double x;
    double y;
};

/// The greatest convex function that no point lies below, at `x`. Precondition: the points rise in
/// x, from `x` or less to `x` or more.
double convex_bound(const std::vector<Point>& points, double x) {
    std::vector<Point> hull;
    for (const Point& next : points) {
        const auto bends_up = [&] {
            const Point &a = hull[hull.size() - 2], &b = hull.back();
            return (b.y - a.y) * (next.x - b.x) < (next.y - b.y) * (b.x - a.x);
        };
        while (hull.size() > 1 && !bends_up()) hull.pop_back();
        hull.push_back(next);
    }
    const auto end = std::ranges::lower_bound(hull, x, {}, &Point::x);
    if (end == hull.begin()) return end->y;
    const Point &a = *(end - 1), &b = *end;
    return a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
}

}  // namespace

UniformReadout full_readout(const ReadoutTiming& timing, FrameShape shape) {
    check_window(timing, shape);
    const RowLoad full = full_row(timing, shape.cols);
    UniformReadout readout;
    readout.channel_columns = full.channel_columns;
    readout.settle = settle_clocks(timing, full.channel_columns);
    readout.convert = convert_clocks(timing, readout.settle, full.conversions);
    readout.transfer = transfer_clocks(timing, full.channel_columns);
    readout.row = row_clocks(timing, readout.convert, readout.transfer);
    readout.lead = lead_clocks(timing, readout.row, readout.convert);
    readout.total = readout.lead + (timing.dark_rows + shape.rows) * readout.row;
    return readout;
}

BalancedReadout balanced_readout(const ReadoutTiming& timing, FrameShape shape, double share) {
    const UniformReadout full = full_readout(timing, shape);
    const double columns = std::max(1.0, share * shape.cols);
    // A quotient that rounding leaves just below a whole number is that number.
    const auto channel_columns =
        static_cast<int>(columns / timing.addressing.channels * (1 + 1e-12));
    const int settle = settle_clocks(timing, std::max(1, channel_columns));
    std::vector<Point> conversion, transfer;
    for (int n = 1; n <= shape.cols; ++n) {
        const RowLoad load = full_row(timing, n);
        const auto at = static_cast<double>(n);
        conversion.push_back(
            {at, static_cast<double>(convert_clocks(timing, settle, load.conversions))});
        transfer.push_back(
            {at, static_cast<double>(transfer_clocks(timing, load.channel_columns))});
    }
    const double converting = convex_bound(conversion, columns);
    const double transferring = convex_bound(transfer, columns);
    const bool turns = timing.row_timing == RowTiming::kSequential;
    BalancedReadout readout;
    readout.row = timing.blanking_clocks +
                  (turns ? converting + transferring : std::max(converting, transferring));
    const auto min_convert = static_cast<std::int64_t>(conversion.front().y);
    const std::int64_t lead = lead_clocks(timing, full.row, min_convert);
    // Conversions may begin with the last overhead row, and so be ahead of transfers.
    const bool ahead = timing.overhead_rows > 0 && !turns;
    const auto head_start = static_cast<double>(ahead ? full.row - min_convert : 0);
    readout.total = static_cast<double>(lead + timing.dark_rows * full.row) +
                    std::max(shape.rows * readout.row - head_start,
                             shape.rows * (transferring + timing.blanking_clocks));
    return readout;
}

}  // namespace stipple
