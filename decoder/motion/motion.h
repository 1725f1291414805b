#pragma once

#include <cstdint>
#include <vector>

#include "core/flux_video.h"
#include "decoder/motion/inverse_search.h"

namespace stipple {

/// Motion from every slot to the one `step` slots away; arrays of order (slot, row, col), one for
/// all planes. The scene at pixel (row, col) is found at (row, col) + shift / 64 in the other slot:
/// inside the frame wherever the confidence is above 0. Slots without a partner have none.
struct MotionField {
    static constexpr int kShiftsPerPixel = kFlowShiftsPerPixel;

    int step = 1;  ///< +1 or -1
    std::vector<std::int16_t> row_shift;
    std::vector<std::int16_t> col_shift;
    std::vector<std::uint8_t> confidence;  ///< 0..255
};

struct MotionOptions {
    /// At half resolution, and averaged with the motion of the slots before and after: for first
    /// estimates, where things stand still for some slots and then jump.
    bool coarse = false;
    InverseSearchOptions search = {};
};

/// Smallest frame, in rows and columns, that motion can be estimated in.
inline constexpr int kMinMotionSide = 16;

/// Motion forwards and backwards in time by dense inverse search (inverse_search.h) on the square
/// root of luminance. The confidence is exp(-e^2 / 2) where forth and back again lead e pixels
/// away. The same bits for any thread count. Precondition: rows, cols >= kMinMotionSide.
[[nodiscard]] std::vector<MotionField> estimate_motion(const FluxVideo& video,
                                                       const MotionOptions& options);

}  // namespace stipple
