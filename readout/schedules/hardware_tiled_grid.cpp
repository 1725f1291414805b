#include "readout/schedules/hardware_tiled_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"

namespace stipple {
namespace {

constexpr double kSigma = 0.8;  ///< groups; of square groups (docs/hardware_schedules.md)
constexpr std::int32_t kFullWeight = 256;

/// exp(-x) for 0 <= x < 1024 with products only, so that it has the same bits everywhere.
double falling(double x) {
    double power = 1 - x / 1024;
    for (int i = 0; i < 10; ++i) power *= power;
    return power;
}

void check(const char* key, int value, int max) {
    if (value < 1 || value > max)
        throw InputError("hardware_tiled", fmt::format("{} {} is outside 1..{}", key, value, max));
}

}  // namespace

GroupGrid grid_of(const HardwareTile& tile) {
    const ColumnAddressing& addressing = tile.addressing;
    check("channels", addressing.channels, ColumnAddressing::kMaxChannels);
    GroupGrid grid;
    if (addressing.kind == ColumnAddressing::Kind::kGroup) {
        check("group_cols", addressing.group_cols, ColumnAddressing::kMaxSide);
        check("group_rows", addressing.group_rows, ColumnAddressing::kMaxSide);
        grid.group_cols = addressing.group_cols;
        grid.group_rows = addressing.group_rows;
    }
    grid.channel_classes = addressing.channels / std::gcd(addressing.channels, grid.group_cols);
    grid.array_cols = (tile.array_cols + grid.group_cols - 1) / grid.group_cols;
    return grid;
}

std::vector<Neighbour> neighbours_of(const GroupGrid& grid, int max_rows, int max_cols) {
    // The longer side of a group counts as less than it measures: motion bridges both sides alike.
    const double aspect = std::sqrt(std::sqrt(1.0 * grid.group_cols / grid.group_rows));
    const double sigma_rows = kSigma * aspect;
    const double sigma_cols = kSigma / aspect;
    const auto reach = [](double sigma, int max) {
        return std::min(max, static_cast<int>(3 * sigma) + 1);
    };
    const int rows = reach(sigma_rows, max_rows);
    const int cols = reach(sigma_cols, max_cols);
    std::vector<Neighbour> neighbours;
    for (int row = -rows; row <= rows; ++row)
        for (int col = -cols; col <= cols; ++col) {
            const double distance2 = 1.0 * row * row / (sigma_rows * sigma_rows) +
                                     1.0 * col * col / (sigma_cols * sigma_cols);
            const auto weight =
                static_cast<std::int32_t>(kFullWeight * falling(0.5 * distance2) + 0.5);
            if (weight > 0 && (row != 0 || col != 0)) neighbours.push_back({row, col, weight});
        }
    return neighbours;
}

RowLoadCount::RowLoadCount(const GroupGrid& grid, const CodeSet& codes)
    : codes_(codes),
      classes_(grid.channel_classes),
      cols_(grid.array_cols > 0 ? grid.array_cols : grid.channel_classes * codes.period()),
      due_(static_cast<std::size_t>(classes_) * static_cast<std::size_t>(codes.period())) {}

int RowLoadCount::even() const {
    const std::int64_t due = static_cast<std::int64_t>(codes_.lengths()) * cols_;
    const auto places = static_cast<std::int64_t>(due_.size());
    return static_cast<int>((due + places - 1) / places);
}

std::int64_t RowLoadCount::counted() const {
    return static_cast<std::int64_t>(codes_.lengths()) * cols_ +
           static_cast<std::int64_t>(due_.size());
}

void RowLoadCount::add(int channel_class, GroupCode code) {
    const int period = codes_.period();
    for (const int slot : codes_.due(code.order))
        ++due_[static_cast<std::size_t>(channel_class) * static_cast<std::size_t>(period) +
               static_cast<std::size_t>((slot + code.first_slot) % period)];
}

}  // namespace stipple
