#include "io/area_average.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"

namespace stipple {
namespace {

/// A pixel and the length of it that lies in an interval.
struct Share {
    int pixel;
    double length;
};

/// The pixels of the interval `i` of `to` equal ones of `from` pixels. Lengths have the unit 1 / to
/// of a pixel, so that they are whole.
std::vector<Share> shares_of(int i, int from, int to) {
    const std::int64_t begin = std::int64_t{i} * from;
    const std::int64_t end = begin + from;
    std::vector<Share> shares;
    for (std::int64_t pixel = begin / to; pixel * to < end; ++pixel)
        shares.push_back(
            {static_cast<int>(pixel),
             static_cast<double>(std::min(end, (pixel + 1) * to) - std::max(begin, pixel * to))});
    return shares;
}

}  // namespace

void average_areas(PlaneView<const float> from, PlaneView<float> to) {
    std::vector<std::vector<Share>> cols;
    cols.reserve(index(to.cols()));
    for (int col = 0; col < to.cols(); ++col)
        cols.push_back(shares_of(col, from.cols(), to.cols()));
    const double area = static_cast<double>(from.rows()) * from.cols();
    parallel_for(0, to.rows(), [&](int row) {
        const std::vector<Share> rows = shares_of(row, from.rows(), to.rows());
        for (int col = 0; col < to.cols(); ++col) {
            double light = 0;
            for (const auto& [source_row, height] : rows) {
                const auto line = from.row(source_row);
                for (const auto& [source_col, width] : cols[index(col)])
                    light += height * width * static_cast<double>(line[index(source_col)]);
            }
            to(row, col) = static_cast<float>(light / area);
        }
    });
}

}  // namespace stipple
