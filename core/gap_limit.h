#pragma once

#include <algorithm>
#include <cstdint>

#include "core/geometry.h"

namespace stipple {

/// Slots that may be missing, over all gaps, beside `present` ones: more are filled in only if the
/// user asks for it. 16 for each that is there, and 1000, of large frames 2^25 values of light, but
/// no fewer than 48: a recording may begin late. So what is filled in is in proportion to the bytes
/// of the file, and 256 MB at most if these are less than 1 MB.
[[nodiscard]] inline std::int64_t max_missing_slots(std::int64_t present, FrameShape shape) {
    constexpr std::int64_t kFreeSlots = 1000;
    constexpr std::int64_t kFewestFree = 48;
    constexpr std::int64_t kFreeSites = std::int64_t{1} << 25U;
    return 16 * present + std::clamp(kFreeSites / static_cast<std::int64_t>(shape.sites()),
                                     kFewestFree, kFreeSlots);
}

}  // namespace stipple
