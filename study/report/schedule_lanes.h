#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "core/exposure_schedule.h"
#include "core/geometry.h"

namespace stipple {

/// The timing diagram of a recording that begins with slot 0: `count` pixels, spread over the tile
/// (sample_pixels), each with `row`, `col` and `exposures`: those that begin in [0, slots), as
/// [first slot, charge store, span, [[first open, open slots], ...]].
[[nodiscard]] nlohmann::ordered_json lanes_json(const ExposureSchedule& schedule, FrameShape array,
                                                int count, std::int64_t slots);

/// The runs of set bits of `Exposure::open_slots` as [first, length].
[[nodiscard]] nlohmann::ordered_json open_runs_json(std::uint64_t open_slots);

}  // namespace stipple
