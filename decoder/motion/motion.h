#pragma once

#include <cstdint>
#include <vector>

#include "core/flux_video.h"
#include "decoder/motion/inverse_search.h"

namespace stipple {

/// Motion from every slot to the slot `step` slots away; arrays of order (slot, row, col), for all
/// planes. The point at pixel (row, col) is at (row, col) + shift / 64 in the other slot, within
/// the frame if the confidence is above 0. Slots without a partner have no confidence.
struct MotionField {
    static constexpr int kShiftsPerPixel = kFlowShiftsPerPixel;

    int step = 1;  ///< +1 or -1
    std::vector<std::int16_t> row_shift;
    std::vector<std::int16_t> col_shift;
    std::vector<std::uint8_t> confidence;  ///< 0..255
};

struct MotionOptions {
    /// At half resolution, and averaged with the motion of the slots before and after: for first
    /// estimates, in which objects stand still for some slots and then jump.
    bool coarse = false;
    InverseSearchOptions search = {};
};

/// Minimum of the rows and columns of a frame for motion estimation.
inline constexpr int kMinMotionSide = 16;

/// Motion forwards and backwards in time by dense inverse search (inverse_search.h) on the square
/// root of luminance. The confidence is exp(-e^2 / 2), where e is the distance in pixels between a
/// point and its position after forward and backward motion. The same bits for any thread count.
/// Precondition: rows, cols >= kMinMotionSide.
[[nodiscard]] std::vector<MotionField> estimate_motion(const FluxVideo& video,
                                                       const MotionOptions& options);

}  // namespace stipple
