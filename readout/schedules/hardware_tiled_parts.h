#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/index.h"
#include "readout/schedules/draws.h"
#include "readout/schedules/hardware_tiled.h"

namespace stipple {

/// The code of a group of pixels: a cyclic order of the lengths and its first slot.
struct GroupCode {
    std::uint16_t order = 0;
    std::uint16_t first_slot = 0;

    auto operator<=>(const GroupCode&) const = default;
};

/// Codes of the groups of a tile, row by row.
struct GroupTile {
    int rows = 0;
    int cols = 0;
    std::vector<GroupCode> codes;

    GroupTile(int tile_rows, int tile_cols)
        : rows(tile_rows), cols(tile_cols), codes(index(tile_rows) * index(tile_cols)) {}
    [[nodiscard]] GroupCode& at(int row, int col) { return codes[row_major(row, col, cols)]; }
    [[nodiscard]] const GroupCode& at(int row, int col) const {
        return codes[row_major(row, col, cols)];
    }
};

/// The possible codes of lengths: up to kMaxOrders cyclic orders of them, each from every slot of
/// the period. Orders are sorted by their sum of products of neighbours, min first: there long and
/// short exposures alternate, so every slot is close to a short exposure.
class CodeSet {
  public:
    static constexpr std::size_t kMaxOrders = 6;  ///< all orders of four different lengths
    /// `overlap` of equal codes without repeated lengths is this times the number of lengths.
    static constexpr std::int32_t kUnit = 1024;

    /// Precondition: 1..16 lengths of 1..64 slots. `draws` choose orders where there are very many.
    CodeSet(std::span<const int> exposure_slots, Draws& draws);

    [[nodiscard]] int period() const { return period_; }
    [[nodiscard]] int orders() const { return static_cast<int>(orders_.size()); }
    /// Number of orders with the same sum of products as the first, such as its mirror image.
    [[nodiscard]] int best_orders() const { return best_orders_; }
    [[nodiscard]] std::size_t lengths() const { return lengths_; }

    /// Slots at whose end a code is read that begins in slot 0; one per length.
    [[nodiscard]] std::span<const int> due(int order) const {
        return due_[static_cast<std::size_t>(order)];
    }

    /// Overlap of two codes: the sum over exposures e of one and f of the other of
    /// overlap(e, f)^2 / (|e| |f|), in 1 / kUnit. Its sum over neighbours is the frame potential of
    /// their exposures (J. J. Benedetto, M. Fickus, "Finite normalized tight frames", Advances in
    /// Computational Mathematics 18, 2003), which is small if neighbours are out of phase.
    [[nodiscard]] std::int32_t overlap(GroupCode a, GroupCode b) const {
        const int shift = b.first_slot - a.first_slot;
        const std::size_t pair = a.order * orders_.size() + b.order;
        return overlaps_[pair * static_cast<std::size_t>(period_) +
                         static_cast<std::size_t>(shift < 0 ? shift + period_ : shift)];
    }

    /// Appends the exposures of a code.
    void append(GroupCode code, std::vector<Exposure>& exposures) const;

  private:
    void choose_orders(std::span<const int> exposure_slots, Draws& draws);
    void list_due();
    void tabulate_overlaps();

    std::size_t lengths_;
    int period_;
    int best_orders_ = 1;
    std::vector<std::vector<int>> orders_;  ///< the lengths in each order
    std::vector<std::vector<int>> due_;
    std::vector<std::int32_t> overlaps_;  ///< by order, order, shift
};

/// The array as rows of groups. Groups with the same (number in the row mod `channel_classes`) load
/// the same channels.
struct GroupGrid {
    int group_rows = 1;       ///< pixels
    int group_cols = 1;       ///< pixels
    int channel_classes = 1;  ///< 1: all groups load all channels alike
    int array_cols = 0;       ///< groups in a row of the array; 0: any number
};

/// \throws InputError if channels or a group is outside 1..65535.
[[nodiscard]] GroupGrid grid_of(const HardwareTile& tile);

/// A group near another one, and the weight of their overlap.
struct Neighbour {
    int row = 0;  ///< relative, in groups
    int col = 0;
    std::int32_t weight = 0;  ///< up to 256
};

/// Neighbours of a group by a Gaussian of the distance, all directions, no further than `max_rows`
/// and `max_cols`.
[[nodiscard]] std::vector<Neighbour> neighbours_of(const GroupGrid& grid, int max_rows,
                                                   int max_cols);

/// Load of the channels by a row of the array, in groups.
class RowLoadCount {
  public:
    /// For tiles of `tile_cols` groups of which one row is given, and codes of `codes`.
    RowLoadCount(const GroupGrid& grid, const CodeSet& codes);

    /// Max number of due groups over channels and slots, if a group has the code
    /// `code_of(group)`.
    template <typename CodeOf>
    [[nodiscard]] int busiest(CodeOf&& code_of) {
        std::ranges::fill(due_, 0);
        for (int group = 0; group < cols_; ++group) add(group % classes_, code_of(group));
        return *std::ranges::max_element(due_);
    }
    /// Lower bound of `busiest`: equal loads of all channels and slots.
    [[nodiscard]] int even() const;
    /// Number of steps of `busiest`.
    [[nodiscard]] std::int64_t counted() const;

  private:
    void add(int channel_class, GroupCode code);

    const CodeSet& codes_;
    int classes_;
    int cols_;
    std::vector<int> due_;  ///< by class and slot
};

/// A tile in which the group (row, col) begins its code in the slot
///     per_row * row + per_col * col + per_period * floor(col / period)    (mod period),
/// all in one order of the lengths. The numbers minimise the frame potential (CodeSet::overlap of
/// neighbours) among those that balance the channels. Where the channels
/// and the period have no common factor, `per_period` is 0 and the tile is period x period.
/// `rows` and `cols` are sizes in groups, 0: the smallest. Nothing if a size is not a multiple of
/// the period.
[[nodiscard]] std::optional<GroupTile> lattice_tile(const GroupGrid& grid, const CodeSet& codes,
                                                    int rows, int cols, Draws& draws);

/// A tile of any size. First each row gets codes for each class of channels that balance the slots:
/// whole sets (one order begun in every slot of the period), and the result of a search for the
/// remaining groups, with the same load in all channels. Then groups of one row and class exchange
/// their codes, which keeps the loads and minimises the frame potential (simulated annealing,
/// CodeSet::overlap of neighbours). If the array ends within a tile, the load of this part of the
/// tile counts too.
[[nodiscard]] GroupTile scatter_tile(const GroupGrid& grid, const CodeSet& codes, int rows,
                                     int cols, Draws& draws);

/// A random code for each group.
[[nodiscard]] GroupTile random_tile(const CodeSet& codes, int rows, int cols, Draws& draws);

/// Exchanges codes of groups of one row and class of channels so that neighbours differ, on a tile
/// that repeats in both directions. The loads of whole tiles do not change. Tries at most 4 million
/// exchanges, which take a second or two.
void anneal_frame_potential(GroupTile& tile, const GroupGrid& grid, const CodeSet& codes,
                            Draws& draws);

}  // namespace stipple
