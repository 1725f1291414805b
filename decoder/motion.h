#pragma once

#include <cstdint>
#include <vector>

#include "core/flux_video.h"

namespace stipple {

/// Motion from every slot to the one `step` slots away; arrays of order (slot, row, col), one for
/// all planes. The scene at pixel (row, col) is found at (row, col) + shift / 64 in the other slot:
/// inside the frame wherever the confidence is above 0. Slots without a partner have none.
struct MotionField {
    static constexpr int kShiftsPerPixel = 64;

    int step = 1;  ///< +1 or -1
    std::vector<std::int16_t> row_shift;
    std::vector<std::int16_t> col_shift;
    std::vector<std::uint8_t> confidence;  ///< 0..255
};

struct MotionOptions {
    int finest_scale = 0;      ///< of the flow: 0 full, 1 half resolution
    int patch_stride_px = 4;   ///< between the patches of the flow, which have 8 x 8 pixels
    int refinements = 1;       ///< variational, of the flow at each scale
    float consistency_px = 1;  ///< confidence exp(-(e / it)^2 / 2), e: forth and back again
};

/// Smallest frame, in rows and columns, that motion can be estimated in.
inline constexpr int kMinMotionSide = 16;

/// Motion forwards and backwards in time by dense inverse search (Kroeger et al., ECCV 2016; the
/// implementation of OpenCV) on the square root of luminance, each direction checked by the
/// other. The same bits for any thread count. Precondition: rows, cols >= kMinMotionSide.
[[nodiscard]] std::vector<MotionField> estimate_motion(const FluxVideo& video,
                                                       const MotionOptions& options);

}  // namespace stipple
