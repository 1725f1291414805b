#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/index.h"
#include "readout/schedules/draws.h"

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

}  // namespace stipple
