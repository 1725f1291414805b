#include "readout/sequencer.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "core/error.h"

namespace stipple {
namespace {

/// Whether a pixel with these exposures collects light in `slot`. As they do not interleave, only
/// the last one to begin can be open. One that would have begun before slot 0 has not begun.
bool is_open(std::span<const Exposure> exposures, std::int64_t slot, int period_slots) {
    if (exposures.empty()) return false;
    const auto phase = static_cast<std::uint32_t>(slot % period_slots);
    const auto next = std::ranges::upper_bound(exposures, phase, {}, &Exposure::first_slot);
    const bool began_last_period = next == exposures.begin();
    const Exposure& e = began_last_period ? exposures.back() : *(next - 1);
    const auto age = std::int64_t{phase} - e.first_slot + (began_last_period ? period_slots : 0);
    return age < e.span_slots() && age <= slot && (e.open_slots >> age & 1U) != 0;
}

/// The same in the first period of a schedule without gaps: what is open before the first exposure
/// of the period began before slot 0.
bool is_open_at_first(std::span<const Exposure> exposures, std::int64_t slot) {
    return slot >= exposures.front().first_slot;
}

struct TilePixel {
    int row;
    int col;
};

/// 1 or 2 for the charge store that collects light in `slot`, or 0, exposures interleaved or not.
std::uint8_t open_store(const ExposureSchedule& schedule, std::int64_t slot, TilePixel pixel) {
    const auto exposures = schedule.exposures(pixel.row, pixel.col);
    const std::int64_t period = schedule.period_slots();
    for (std::size_t i = 0; i < exposures.size(); ++i) {
        const Exposure& e = exposures[i];
        const std::int64_t age = (slot - e.first_slot + period) % period;  // if slot >= 0, no less
        if (age < e.span_slots() && age <= slot && (e.open_slots >> age & 1U) != 0) {
            const std::int64_t repetition = (slot - age) / period;
            return static_cast<std::uint8_t>(1 +
                                             schedule.store(pixel.row, pixel.col, i, repetition));
        }
    }
    return 0;
}

}  // namespace

Sequencer::Sequencer(const ExposureSchedule& schedule, FrameShape shape)
    : parts_{{&schedule}}, cols_(shape.cols), gapless_(schedule.gapless()) {
    assert(schedule.charge_stores() <= 2);
}

void Sequencer::switch_to(const ExposureSchedule& next, std::int64_t slot) {
    assert(slot > parts_.back().first_slot && !next.interleaved() && !schedule().interleaved());
    parts_.push_back({&next, slot});
    gapless_ = next.gapless();
}

bool Sequencer::all_open(std::int64_t slot) const noexcept {
    return gapless_ && readout_slot(parts_.back(), slot) + 1 >= schedule().longest_span_slots();
}

void Sequencer::list_open(std::int64_t slot, int row, std::span<std::uint8_t> open) const noexcept {
    assert(open.size() == static_cast<std::size_t>(cols_));
    slot = readout_slot(parts_.back(), slot);
    const int tile_row = row % schedule().tile_rows();
    const auto once = static_cast<std::size_t>(std::min(cols_, schedule().tile_cols()));
    const int period = schedule().period_slots();
    const bool at_first = gapless_ && slot < period;
    const bool interleaved = schedule().interleaved();
    for (std::size_t i = 0; i < once; ++i) {
        const auto col = static_cast<int>(i);
        const auto exposures = schedule().exposures(tile_row, col);
        if (interleaved)
            open[i] = open_store(schedule(), slot, {tile_row, col});
        else
            open[i] =
                at_first ? is_open_at_first(exposures, slot) : is_open(exposures, slot, period);
    }
    for (std::size_t col = once; col < open.size(); ++col) open[col] = open[col - once];
}

void Sequencer::append_due(std::int64_t slot, int row, std::vector<std::uint32_t>& pixels) const {
    const auto first = static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(cols_);
    for_each_readout(schedule(), readout_slot(parts_.back(), slot), row, cols_, [&](int col, int) {
        pixels.push_back(first + static_cast<std::uint32_t>(col));
    });
}

void Sequencer::append_stores(std::int64_t slot, int row, std::vector<std::uint8_t>& stores) const {
    const int tile_row = row % schedule().tile_rows();
    for_each_readout(schedule(), slot, row, cols_, [&](int col, int) {
        const TilePixel pixel{tile_row, col % schedule().tile_cols()};
        stores.push_back(static_cast<std::uint8_t>(open_store(schedule(), slot, pixel) - 1));
    });
}

void Sequencer::append_open_slots(std::int64_t slot, int row,
                                  std::vector<std::uint16_t>& slots) const {
    const SchedulePart& part = parts_.back();
    const bool across = part.first_slot > 0 && slot < part.first_slot + schedule().period_slots();
    visit_due_pixels(schedule(), readout_slot(part, slot), row, cols_,
                     [&](int col, const DuePixel& pixel) {
                         int open = pixel.light_slots;
                         if (across)
                             if (const auto read = read_exposure(parts_, {slot, row, col}))
                                 open = std::popcount(read->open_slots);
                         slots.push_back(static_cast<std::uint16_t>(open));
                     });
}

}  // namespace stipple
