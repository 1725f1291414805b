#pragma once

#include <algorithm>
#include <cstdint>

#include "core/geometry.h"

namespace stipple {

/// Max number of missing slots, over all gaps, that are filled in beside `present` slots without a
/// request of the user: 16 per present slot, plus 1000 (for large frames 2^25 values of light, but
/// at least 48), because a stream may begin late. So the filled slots are in proportion to the
/// bytes of the file, and at most 256 MB for files below 1 MB.
[[nodiscard]] inline std::int64_t max_missing_slots(std::int64_t present, FrameShape shape) {
    constexpr std::int64_t kMaxFreeSlots = 1000;
    constexpr std::int64_t kMinFreeSlots = 48;
    constexpr std::int64_t kFreeSites = std::int64_t{1} << 25U;
    return 16 * present + std::clamp(kFreeSites / static_cast<std::int64_t>(shape.sites()),
                                     kMinFreeSlots, kMaxFreeSlots);
}

}  // namespace stipple
