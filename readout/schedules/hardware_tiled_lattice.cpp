#include "readout/schedules/hardware_tiled_parts.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace stipple {
namespace {

constexpr std::int64_t kMaxCounted = std::int64_t{1} << 27U;  ///< well under a second
constexpr int kMaxPerPeriod = 16;  ///< values of per_period that are tried
constexpr int kSpare = 20;         ///< a load is even up to 1 / 20

struct Lattice {
    int per_row = 0;
    int per_col = 0;
    int per_period = 0;
    std::int64_t potential = 0;
};

int wrapped(int slot, int period) {
    return (slot % period + period) % period;
}

GroupCode code_at(const Lattice& lattice, int order, int row, int col, int period) {
    const std::int64_t slot = std::int64_t{lattice.per_row} * row +
                              std::int64_t{lattice.per_col} * col +
                              std::int64_t{lattice.per_period} * (col / period);
    return {static_cast<std::uint16_t>(order), static_cast<std::uint16_t>(slot % period)};
}

/// Every lattice with per_period 0, the min potential first, equal ones in random order.
std::vector<Lattice> list_lattices(const GroupGrid& grid, const CodeSet& codes, int order,
                                   Draws& draws) {
    const int period = codes.period();
    const auto neighbours = neighbours_of(grid, period, period);
    const GroupCode here{static_cast<std::uint16_t>(order), 0};
    std::vector<Lattice> lattices;
    for (int per_row = 0; per_row < period; ++per_row)
        for (int per_col = 0; per_col < period; ++per_col) {
            std::int64_t potential = 0;
            for (const auto& [row, col, weight] : neighbours) {
                const int slot = wrapped(per_row * row + per_col * col, period);
                potential += std::int64_t{weight} *
                             codes.overlap(here, {here.order, static_cast<std::uint16_t>(slot)});
            }
            lattices.push_back({per_row, per_col, 0, potential});
        }
    for (std::size_t i = lattices.size() - 1; i > 0; --i)
        std::swap(lattices[i], lattices[draws.below(i + 1)]);
    std::ranges::stable_sort(lattices, {}, &Lattice::potential);
    return lattices;
}

/// Chooses lattices by how they load channels.
class EvenLattice {
  public:
    EvenLattice(const GroupGrid& grid, const CodeSet& codes, int order, int max_per_period)
        : codes_(codes),
          order_(order),
          max_per_period_(max_per_period),
          load_(grid, codes),
          best_of_(static_cast<std::size_t>(codes.period())) {}

    /// The first of `lattices` that is even, or else the most even one.
    Lattice choose(const std::vector<Lattice>& lattices) {
        Lattice best = lattices.front();
        int min_load = -1;
        for (Lattice lattice : lattices) {
            auto& [load, per_period] = best_of_[static_cast<std::size_t>(lattice.per_col)];
            if (load != 0) continue;  // another per_row changes no load
            std::tie(load, per_period) = best_for(lattice);
            lattice.per_period = per_period;
            if (min_load < 0 || load < min_load) {
                min_load = load;
                best = lattice;
            }
            if (min_load <= load_.even() + load_.even() / kSpare || counted_ > kMaxCounted) break;
        }
        return best;
    }

  private:
    /// The min load with one of the values of per_period, and the value.
    std::pair<int, int> best_for(Lattice lattice) {
        std::pair<int, int> best{-1, 0};
        for (lattice.per_period = 0; lattice.per_period <= max_per_period_; ++lattice.per_period) {
            const int load = load_.busiest(
                [&](int group) { return code_at(lattice, order_, 0, group, codes_.period()); });
            if (best.first < 0 || load < best.first) best = {load, lattice.per_period};
            counted_ += load_.counted();
            if (counted_ > kMaxCounted) break;
        }
        return best;
    }

    const CodeSet& codes_;
    int order_;
    int max_per_period_;
    RowLoadCount load_;
    std::int64_t counted_ = 0;
    std::vector<std::pair<int, int>> best_of_;  ///< load and per_period, by per_col
};

}  // namespace

std::optional<GroupTile> lattice_tile(const GroupGrid& grid, const CodeSet& codes, int rows,
                                      int cols, Draws& draws) {
    const int period = codes.period();
    if (rows % period != 0 || cols % period != 0) return {};
    const bool shared_factor = std::gcd(grid.channel_classes, period) > 1;
    const int max_per_period = cols == 0 && shared_factor ? std::min(kMaxPerPeriod, period) - 1 : 0;
    const auto order = static_cast<int>(draws.below(static_cast<std::size_t>(codes.best_orders())));
    const Lattice lattice = EvenLattice(grid, codes, order, max_per_period)
                                .choose(list_lattices(grid, codes, order, draws));
    if (rows == 0) rows = period;
    if (cols == 0) cols = period * (period / std::gcd(lattice.per_period, period));
    GroupTile tile(rows, cols);
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col)
            tile.at(row, col) = code_at(lattice, order, row, col, period);
    return tile;
}

}  // namespace stipple
