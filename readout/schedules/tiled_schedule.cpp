#include "readout/schedules/tiled_schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "readout/schedules/draws.h"

namespace stipple {
namespace {

constexpr char kWhere[] = "tiled schedule";
constexpr std::size_t kMaxDrawn = 1U << 23U;  ///< well under a second

int period_of(std::span<const int> lengths) {
    return std::accumulate(lengths.begin(), lengths.end(), 0);
}

/// Draws what one pixel repeats: a permutation of `lengths` from a random offset.
void draw_pixel(Draws& draws, std::span<const int> lengths, std::span<Exposure> exposures) {
    for (std::size_t i = 0; i < lengths.size(); ++i)
        exposures[i].open_slots = open_without_gap(lengths[i]);
    for (std::size_t i = lengths.size() - 1; i > 0; --i)
        std::swap(exposures[i], exposures[draws.below(i + 1)]);
    const auto period = static_cast<std::uint32_t>(period_of(lengths));
    std::uint32_t slot = draws.below(period);
    for (Exposure& e : exposures) {
        e.first_slot = slot % period;
        slot += static_cast<std::uint32_t>(e.span_slots());
    }
}

/// Exchanges two exposures that follow each other, which moves one beginning and no other.
void swap_neighbours(Draws& draws, std::uint32_t period, std::span<Exposure> exposures) {
    const std::size_t i = draws.below(exposures.size() - 1);
    std::swap(exposures[i].open_slots, exposures[i + 1].open_slots);
    const auto span_slots = static_cast<std::uint32_t>(exposures[i].span_slots());
    exposures[i + 1].first_slot = (exposures[i].first_slot + span_slots) % period;
}

/// Exposures that begin in each slot: as none has a gap after it, one ends in the slot before.
class SlotCounts {
  public:
    explicit SlotCounts(std::size_t period) : begun_(period, 0) {}

    void add(std::span<const Exposure> exposures) {
        for (const Exposure& e : exposures) sum_of_squares_ += 2 * begun_[e.first_slot]++ + 1;
    }
    void remove(std::span<const Exposure> exposures) {
        for (const Exposure& e : exposures) sum_of_squares_ -= 2 * begun_[e.first_slot]-- - 1;
    }
    [[nodiscard]] std::uint32_t period() const { return static_cast<std::uint32_t>(begun_.size()); }
    /// Falls as the counts become even.
    [[nodiscard]] std::int64_t sum_of_squares() const { return sum_of_squares_; }
    /// Its least value for so many exposures: no two counts differ by more than 1.
    [[nodiscard]] std::int64_t min_sum_of_squares() const {
        const auto total = std::accumulate(begun_.begin(), begun_.end(), std::int64_t{0});
        const auto slots = static_cast<std::int64_t>(begun_.size());
        const auto each = total / slots;
        return slots * each * each + total % slots * (2 * each + 1);
    }

  private:
    std::vector<std::int64_t> begun_;
    std::int64_t sum_of_squares_ = 0;
};

void check(int tile_rows, int tile_cols, std::span<const int> lengths) {
    if (tile_rows < 1 || tile_cols < 1 || tile_rows > kMaxTiledSide || tile_cols > kMaxTiledSide)
        throw InputError(kWhere, fmt::format("tile {} x {} is outside 1..{} rows and columns",
                                             tile_rows, tile_cols, kMaxTiledSide));
    if (lengths.empty() || lengths.size() > kMaxTiledLengths)
        throw InputError(kWhere,
                         fmt::format("{} lengths; give 1 to {}", lengths.size(), kMaxTiledLengths));
    for (const int length : lengths)
        if (length < 1 || length > kMaxExposureSlots)
            throw InputError(kWhere, fmt::format("exposure of {} slots is outside 1..64", length));
}

/// What each pixel of a tile repeats, `each` exposures per pixel.
struct Tile {
    std::size_t each;
    std::vector<Exposure> exposures;

    [[nodiscard]] std::size_t pixels() const { return exposures.size() / each; }
    std::span<Exposure> pixel(std::size_t p) {
        return std::span(exposures).subspan(p * each, each);
    }
};

/// Changes pixels at random, now a little, now altogether, and keeps what is not less even, until
/// no two slots differ by more than one or `kMaxDrawn` exposures have been tried.
void even_out(Tile& tile, SlotCounts& counts, std::span<const int> lengths, Draws& draws) {
    const std::int64_t min_sum = counts.min_sum_of_squares();
    std::vector<Exposure> other(tile.each);
    for (std::size_t drawn = 0; drawn < kMaxDrawn && counts.sum_of_squares() > min_sum;
         drawn += tile.each) {
        const auto current = tile.pixel(draws.below(tile.pixels()));
        if (tile.each > 1 && draws.below(2) == 0) {
            std::ranges::copy(current, other.begin());
            swap_neighbours(draws, counts.period(), other);
        } else {
            draw_pixel(draws, lengths, other);
        }
        const std::int64_t before = counts.sum_of_squares();
        counts.remove(current);
        counts.add(other);
        if (counts.sum_of_squares() <= before) {
            std::ranges::copy(other, current.begin());
        } else {
            counts.remove(other);
            counts.add(current);
        }
    }
}

}  // namespace

ExposureSchedule full_schedule(int open_slots, int period_slots) {
    if (open_slots < 1 || open_slots > kMaxExposureSlots || open_slots > period_slots)
        throw InputError("exposure schedule",
                         fmt::format("{} open slots in a period of {}: needs 1 to {} open slots "
                                     "and a period not shorter",
                                     open_slots, period_slots, kMaxExposureSlots));
    return {1, 1, period_slots, {0, 1}, {{0, open_without_gap(open_slots)}}};
}

ExposureSchedule tiled_schedule(int tile_rows, int tile_cols, std::span<const int> exposure_slots,
                                std::uint64_t seed) {
    check(tile_rows, tile_cols, exposure_slots);
    const std::size_t pixels =
        static_cast<std::size_t>(tile_rows) * static_cast<std::size_t>(tile_cols);
    const int period_slots = period_of(exposure_slots);
    Tile tile{exposure_slots.size(), std::vector<Exposure>(pixels * exposure_slots.size())};
    SlotCounts counts(static_cast<std::size_t>(period_slots));
    Draws draws(seed, DrawPlane::kTiled);
    for (std::size_t p = 0; p < pixels; ++p) {
        draw_pixel(draws, exposure_slots, tile.pixel(p));
        counts.add(tile.pixel(p));
    }
    even_out(tile, counts, exposure_slots, draws);

    std::vector<std::uint32_t> first(pixels + 1);
    for (std::size_t p = 0; p <= pixels; ++p) first[p] = static_cast<std::uint32_t>(p * tile.each);
    return {tile_rows, tile_cols, period_slots, std::move(first), std::move(tile.exposures)};
}

}  // namespace stipple
