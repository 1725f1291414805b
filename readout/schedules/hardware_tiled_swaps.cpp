#include "readout/schedules/hardware_tiled_parts.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace stipple {
namespace {

constexpr std::int64_t kMaxSwaps = 4'000'000;
constexpr std::int64_t kSwapsPerGroup = 200;
// Of overlap x weight (1024 x 256): rises by this much are often accepted first, and last.
constexpr double kFirstHeat = 130'000;
constexpr double kLastHeat = 2'600;
/// What a step of the sum of squares of a channel's loads counts.
constexpr std::int64_t kLoadCost = 50'000;

/// What the columns of a tile load channels with beyond whole tiles, where the array ends.
class PartTileLoads {
  public:
    PartTileLoads(const GroupTile& tile, const GroupGrid& grid, const CodeSet& codes)
        : codes_(&codes), parts_of_(static_cast<std::size_t>(tile.cols)) {
        list_parts(tile.cols, grid);
        const auto period = static_cast<std::size_t>(codes.period());
        due_.resize(static_cast<std::size_t>(tile.rows) * parts_ * period);
        for (int row = 0; row < tile.rows; ++row)
            for (int col = 0; col < tile.cols; ++col) add(row, col, tile.at(row, col), 1);
    }

    /// What the sum of squares changes when `from` leaves the place and `to` comes.
    std::int64_t replace(int row, int col, GroupCode from, GroupCode to) {
        return add(row, col, from, -1) + add(row, col, to, 1);
    }

  private:
    void list_parts(int tile_cols, const GroupGrid& grid) {
        const int classes = grid.channel_classes;
        const int round =
            tile_cols / std::gcd(tile_cols, classes);  // groups until the tile repeats
        std::vector<std::pair<int, int>> parts;        // first column, groups
        parts.reserve(static_cast<std::size_t>(std::min(classes, grid.array_cols)));
        for (int first = 0; first < std::min(classes, grid.array_cols); ++first)
            parts.emplace_back(first % tile_cols,
                               ((grid.array_cols - 1 - first) / classes + 1) % round);
        std::ranges::sort(parts);
        parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
        for (const auto& [first, groups] : parts) {
            for (int i = 0; i < groups; ++i) {
                const std::int64_t col = first + std::int64_t{i} * classes;
                parts_of_[static_cast<std::size_t>(col % tile_cols)].push_back(parts_);
            }
            ++parts_;
        }
    }

    std::int64_t add(int row, int col, GroupCode code, int times) {
        const int period = codes_->period();
        std::int64_t change = 0;
        for (const std::size_t part : parts_of_[static_cast<std::size_t>(col)]) {
            const auto base =
                (static_cast<std::size_t>(row) * parts_ + part) * static_cast<std::size_t>(period);
            for (const int slot : codes_->due(code.order)) {
                int& due = due_[base + static_cast<std::size_t>((slot + code.first_slot) % period)];
                change += 2 * times * due + 1;
                due += times;
            }
        }
        return change;
    }

    const CodeSet* codes_;
    std::size_t parts_ = 0;
    std::vector<std::vector<std::size_t>> parts_of_;  ///< by column
    std::vector<int> due_;                            ///< by row, part and slot
};

std::vector<Neighbour> neighbours_within(const GroupTile& tile, const GroupGrid& grid) {
    return neighbours_of(grid, (tile.rows - 1) / 2, (tile.cols - 1) / 2);
}

/// Two groups of one row.
struct Pair {
    int row;
    int col;
    int other;
};

/// Simulated annealing of a tile.
class Annealing {
  public:
    Annealing(GroupTile& tile, const GroupGrid& grid, const CodeSet& codes)
        : tile_(tile),
          codes_(codes),
          neighbours_(neighbours_within(tile, grid)),
          loads_(tile, grid, codes) {}

    /// Exchanges two groups if that lowers the cost, or raises it by no more than a random number
    /// of mean `temperature`.
    void step(const Pair& pair, double temperature, std::uint32_t random) {
        GroupCode& a = tile_.at(pair.row, pair.col);
        GroupCode& b = tile_.at(pair.row, pair.other);
        if (a == b) return;
        std::int64_t change =
            cost(pair.row, pair.col, b, pair.other) - cost(pair.row, pair.col, a, pair.other) +
            cost(pair.row, pair.other, a, pair.col) - cost(pair.row, pair.other, b, pair.col);
        change = 2 * change + kLoadCost * move_loads(pair, a, b);
        if (static_cast<double>(change) <= temperature * exponential(random))
            std::swap(a, b);
        else
            move_loads(pair, b, a);
    }

  private:
    /// The potential between `code` in a place and its neighbours but the one in column `without`:
    /// the two that are exchanged see each other alike before and after.
    [[nodiscard]] std::int64_t cost(int row, int col, GroupCode code, int without) const {
        std::int64_t sum = 0;
        for (const Neighbour& neighbour : neighbours_) {
            const int near_col = wrapped(col + neighbour.col, tile_.cols);
            if (neighbour.row == 0 && near_col == without) continue;
            const GroupCode near = tile_.at(wrapped(row + neighbour.row, tile_.rows), near_col);
            sum += std::int64_t{neighbour.weight} * codes_.overlap(code, near);
        }
        return sum;
    }

    std::int64_t move_loads(const Pair& pair, GroupCode from, GroupCode to) {
        return loads_.replace(pair.row, pair.col, from, to) +
               loads_.replace(pair.row, pair.other, to, from);
    }

    static int wrapped(int place, int size) {
        return place < 0 ? place + size : place >= size ? place - size : place;
    }

    /// Close to an exponential distribution of mean 1: -log2 of a uniform number, linear between
    /// powers of two, without libm.
    static double exponential(std::uint32_t random) {
        const std::uint32_t word = random | 1U;
        const int zeros = std::countl_zero(word);
        const double mantissa =
            static_cast<double>(word << static_cast<unsigned>(zeros)) / 2147483648.0;
        return 0.6931 * (zeros + 2 - mantissa);
    }

    GroupTile& tile_;
    const CodeSet& codes_;
    std::vector<Neighbour> neighbours_;
    PartTileLoads loads_;
};

}  // namespace

void anneal_frame_potential(GroupTile& tile, const GroupGrid& grid, const CodeSet& codes,
                            Draws& draws) {
    const int classes = std::gcd(tile.cols, grid.channel_classes);
    const int places = tile.cols / classes;
    if (places < 2) return;
    Annealing annealing(tile, grid, codes);
    const auto groups = static_cast<std::int64_t>(tile.codes.size());
    const std::int64_t swaps = std::min(kMaxSwaps, groups * kSwapsPerGroup);
    for (std::int64_t rest = swaps; rest > 0; --rest) {
        const double part = static_cast<double>(rest) / static_cast<double>(swaps);
        const double temperature = kLastHeat + (kFirstHeat - kLastHeat) * part * part * part;
        const auto row = static_cast<int>(draws.below(static_cast<std::size_t>(tile.rows)));
        const auto col = static_cast<int>(draws.below(static_cast<std::size_t>(tile.cols)));
        const auto step = 1 + static_cast<int>(draws.below(static_cast<std::size_t>(places - 1)));
        const int other = (col + step * classes) % tile.cols;
        annealing.step({row, col, other}, temperature, draws.below(std::size_t{1} << 32U));
    }
}

}  // namespace stipple
