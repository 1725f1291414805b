#pragma once

#include <cstddef>
#include <cstdint>

#include "core/exposure_schedule.h"

namespace stipple {

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
