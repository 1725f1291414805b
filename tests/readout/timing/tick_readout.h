#pragma once

#include <cstdint>
#include <span>

#include "readout/timing/slot_readout.h"

namespace stipple {

/// What `read_slot` computes, clock by clock, by machines for row selection, ADCs and link that
/// know only their own state: the reference.
[[nodiscard]] SlotTimes read_slot_by_ticks(const ReadoutTiming& timing, int cols,
                                           std::span<const RowLoad> loads, std::int64_t begin);

}  // namespace stipple
