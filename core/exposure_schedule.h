#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/index.h"

namespace stipple {

inline constexpr int kMaxExposureSlots = 64;  ///< bits of `Exposure::open_slots`
inline constexpr int kMaxPeriodSlots = 65535;
inline constexpr int kMaxTileSide = kMaxFrameSide;
inline constexpr float kMinSlotWeight = 0x1p-20F;
inline constexpr float kMaxSlotWeight = 0x1p20F;

/// One exposure of one pixel: the slots in which its shutter is open. Bit i of `open_slots` is
/// slot `first_slot + i`; bit 0 is set. It is read out at the end of its last open slot.
struct Exposure {
    std::uint32_t first_slot = 0;  ///< 0 <= first_slot < period
    std::uint64_t open_slots = 1;

    /// Slots from the first to the last open one.
    [[nodiscard]] int span_slots() const { return static_cast<int>(std::bit_width(open_slots)); }
    /// Slots that collect light.
    [[nodiscard]] int light_slots() const { return std::popcount(open_slots); }
    bool operator==(const Exposure&) const = default;
};

/// `Exposure::open_slots` of `slots` slots in succession. Precondition: 1 <= slots <= 64.
[[nodiscard]] constexpr std::uint64_t open_without_gap(int slots) {
    return ~std::uint64_t{0} >> static_cast<unsigned>(64 - slots);
}

/// A pixel that is due for readout, in a row of the tile.
struct DuePixel {
    std::uint16_t col = 0;         ///< column in the tile
    std::uint8_t span_slots = 0;   ///< slots since the exposure began, this one included
    std::uint8_t light_slots = 0;  ///< slots of these that have collected light
};

/// Which pixel exposes when: a tile of rows x cols pixels, repeated over the array, whose
/// exposures repeat every `period_slots`. No two exposures of a pixel share a slot, so each
/// (pixel, slot) belongs to at most one exposure and the sampling operator has A A^T diagonal.
/// With weights an exposure collects weight x light in each slot, as behind a grey mask; without
/// them all weights are 1. Copies share the list of exposures, which never changes.
class ExposureSchedule {
  public:
    /// `exposures[first[p] .. first[p + 1])` belong to tile pixel p = row * tile_cols + col.
    /// \throws InputError naming the pixel and the slot of the first rule broken: an empty tile or
    /// period, an exposure outside 0 <= first_slot < period or longer than the period, bit 0
    /// clear, or two exposures of a pixel open in one slot.
    ExposureSchedule(int tile_rows, int tile_cols, int period_slots,
                     std::vector<std::uint32_t> first, std::vector<Exposure> exposures);

    /// Gives each open (slot, pixel) of the tile a weight of 2^-20..2^20. Order (slot of the
    /// period, row, col); closed slots have the weight 0. Weights that are all 1 count as none.
    /// \throws InputError naming the pixel and the slot of the first weight outside these limits.
    void set_weights(std::vector<float> weights);
    [[nodiscard]] bool weighted() const { return !weights_.empty(); }
    /// In the order of `set_weights`; empty without weights.
    [[nodiscard]] std::span<const float> weights() const { return weights_; }
    /// Weight of a tile pixel in slot `phase` (0 .. period - 1). Precondition: weighted().
    [[nodiscard]] float weight(int phase, int tile_row, int tile_col) const {
        return weights_[index(phase) * pixels() + pixel(tile_row, tile_col)];
    }

    /// Sum of the weights of the open slots of an exposure of a tile pixel; without weights their
    /// number.
    [[nodiscard]] double light_slots(int tile_row, int tile_col, const Exposure& exposure) const;

    [[nodiscard]] int tile_rows() const { return tile_rows_; }
    [[nodiscard]] int tile_cols() const { return tile_cols_; }
    [[nodiscard]] int period_slots() const { return period_slots_; }

    /// Exposures of a tile pixel, by first slot.
    [[nodiscard]] std::span<const Exposure> exposures(int tile_row, int tile_col) const;

    /// Pixels of a tile row read out at the end of slot `phase` (0 .. period - 1), by column.
    [[nodiscard]] std::span<const DuePixel> due(int phase, int tile_row) const;

    /// Samples per pixel and slot, on average; its inverse is the compression ratio.
    [[nodiscard]] double samples_per_pixel_slot() const;
    /// Fraction of all (pixel, slot) pairs that collect light; with weights their mean weight.
    [[nodiscard]] double light_throughput() const;
    /// True if every pixel collects light in every slot.
    [[nodiscard]] bool gapless() const;
    /// True if some pixel begins an exposure before an earlier one has ended (two-bucket pixels).
    [[nodiscard]] bool interleaved() const { return charge_stores() > 1; }
    /// Max simultaneous exposures of a pixel: the charge stores that it needs.
    [[nodiscard]] int charge_stores() const { return lists_->max_at_once; }
    /// Max span of an exposure; 0 without exposures.
    [[nodiscard]] int longest_span_slots() const { return lists_->longest_span_slots; }
    /// The charge store (0 or 1) of exposure `i` of a tile pixel that begins in the given
    /// repetition (begin slot / period_slots). Simultaneous exposures have different stores. The
    /// store alternates between repetitions if an odd number of exposures follow each other around
    /// the period. Precondition: charge_stores() <= 2.
    [[nodiscard]] int store(int tile_row, int tile_col, std::size_t i,
                            std::int64_t repetition) const {
        if (lists_->stores.empty()) return 0;
        return lists_->stores[lists_->first[pixel(tile_row, tile_col)] + i] >> (repetition & 1) & 1;
    }

    bool operator==(const ExposureSchedule&) const;

  private:
    [[nodiscard]] std::size_t pixel(int tile_row, int tile_col) const {
        return row_major(tile_row, tile_col, tile_cols_);
    }
    [[nodiscard]] std::size_t pixels() const { return index(tile_rows_) * index(tile_cols_); }

    struct Lists {
        int max_at_once = 1;
        int longest_span_slots = 0;
        std::vector<std::uint32_t> first;
        std::vector<Exposure> exposures;
        std::vector<std::uint8_t> stores;      ///< by exposure, bit 0 in even repetitions, bit 1 in
                                               ///< odd; empty unless there are two stores
        std::vector<std::uint32_t> first_due;  ///< by phase * tile_rows + tile_row
        std::vector<DuePixel> due;
    };
    /// `zeros` has a zero per slot of the period before and after the call; clearing it for each
    /// pixel would take seconds.
    void check_pixel(Lists& lists, int pixel, std::span<int> zeros) const;
    [[nodiscard]] double open_fraction() const;
    void assign_stores(Lists& lists) const;
    void list_due_pixels(Lists& lists) const;
    [[nodiscard]] std::span<const Exposure> exposures_in(const Lists& lists, std::size_t p) const {
        return std::span(lists.exposures)
            .subspan(lists.first[p], lists.first[p + 1] - lists.first[p]);
    }

    int tile_rows_;
    int tile_cols_;
    int period_slots_;
    std::shared_ptr<const Lists> lists_;
    std::vector<float> weights_;
};

/// Calls `visit(col, due_pixel)` for each pixel of array row `row` that is read out at the end of
/// `slot`, in scan order. The array is reset before slot 0, so an exposure that would have begun
/// earlier is not read. The one definition of which samples a slot holds, shared by the chip, the
/// stream and the decoder. Precondition: slot >= 0, row >= 0.
template <typename Visit>
void visit_due_pixels(const ExposureSchedule& schedule, std::int64_t slot, int row, int cols,
                      Visit&& visit) {
    const auto phase = static_cast<int>(slot % schedule.period_slots());
    const auto due = schedule.due(phase, row % schedule.tile_rows());
    for (int tile_col = 0; tile_col < cols; tile_col += schedule.tile_cols())
        for (const DuePixel& pixel : due) {
            const int col = tile_col + pixel.col;
            if (col >= cols) break;
            if (pixel.span_slots <= slot + 1) visit(col, pixel);
        }
}

/// The same with `visit(col, span_slots)`.
template <typename Visit>
void for_each_readout(const ExposureSchedule& schedule, std::int64_t slot, int row, int cols,
                      Visit&& visit) {
    visit_due_pixels(schedule, slot, row, cols, [&](int col, const DuePixel& pixel) {
        visit(col, static_cast<int>(pixel.span_slots));
    });
}

/// Number of pixels that `for_each_readout` visits in rows [first_row, first_row + rows).
[[nodiscard]] std::size_t count_due(const ExposureSchedule& schedule, std::int64_t slot,
                                    int first_row, int rows, int cols);

/// Exposure lengths of the paper, in slots.
inline constexpr int kPaperExposureSlots[] = {1, 2, 4, 8};

/// Generates the exposures of `random_schedule` pixel by pixel.
class RandomExposures {
  public:
    /// \throws InputError as random_schedule.
    RandomExposures(std::span<const int> exposure_slots, std::uint64_t seed);

    [[nodiscard]] int period_slots() const { return period_slots_; }
    /// Exposures of pixel row * cols + col, by first slot; valid until the next call.
    [[nodiscard]] std::span<const Exposure> of(std::uint32_t pixel);

  private:
    std::vector<int> exposure_slots_;
    std::uint64_t seed_;
    int period_slots_ = 0;
    std::vector<int> order_;
    std::vector<Exposure> exposures_;
};

/// The paper's schedule: every pixel of a rows x cols array repeats its own random permutation
/// of `exposure_slots` without gaps, from a random offset. The stream format defines its bits
/// (docs/stream_format.md), so a header needs only the lengths and the seed.
/// \throws InputError if there is no length, one is outside 1..64, or the sum of lengths exceeds
/// 65535.
[[nodiscard]] ExposureSchedule random_schedule(int rows, int cols,
                                               std::span<const int> exposure_slots,
                                               std::uint64_t seed);

/// Peak memory of `random_schedule` in bytes, most of which the result keeps.
[[nodiscard]] std::uint64_t random_schedule_bytes(int rows, int cols,
                                                  std::span<const int> exposure_slots);

/// Index of the exposure of a tile pixel that begins in slot `begin_slot`, in any repetition of the
/// period. Precondition: it has one, as the pixels have that `for_each_readout` visits.
[[nodiscard]] inline std::size_t exposure_starting_at(const ExposureSchedule& schedule,
                                                      int tile_row, int tile_col,
                                                      std::int64_t begin_slot) {
    const auto first = static_cast<std::uint32_t>(begin_slot % schedule.period_slots());
    const auto exposures = schedule.exposures(tile_row, tile_col);
    std::size_t i = 0;
    while (exposures[i].first_slot != first) ++i;
    return i;
}

}  // namespace stipple
