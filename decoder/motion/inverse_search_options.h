#pragma once

namespace stipple {

inline constexpr int kFlowShiftsPerPixel = 64;  ///< shifts are in 1 / 64 pixels

/// Of the dense inverse search (inverse_search.h).
struct InverseSearchOptions {
    int patch_stride_px = 4;       ///< between patches
    float range_sigma_px = 0.03F;  ///< range sigma of the bilateral filter of the shifts
};

}  // namespace stipple
