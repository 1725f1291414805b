#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/flux_video.h"

namespace stipple {

inline constexpr int kFlowShiftsPerPixel = 64;  ///< shifts are in 1 / 64 pixels

/// Of the dense inverse search (inverse_search.h).
struct InverseSearchOptions {
    int patch_stride_px = 4;       ///< between patches
    float range_sigma_px = 0.03F;  ///< range sigma of the bilateral filter of the shifts
};

/// Input of the optical flow: 255 sqrt(luminance) of a slot, order (row, col). The square root
/// gives the same bits everywhere; a power of 1/2.2 does not.
[[nodiscard]] std::vector<std::uint8_t> grey_levels(const FluxVideo& video, int slot);

/// Pixels repeated around the image of a flow, so that patches may leave the image.
inline constexpr int kFlowBorder = 16;

/// Side of the patches of the flow, in pixels.
inline constexpr int kFlowPatchSide = 8;

/// One level of an image pyramid, 8 bits; kFlowBorder more pixels can be read on each side.
struct FlowImage {
    const std::uint8_t* pixels = nullptr;
    std::ptrdiff_t stride = 0;  ///< between rows
    int rows = 0;               ///< at least kFlowPatchSide
    int cols = 0;
};

/// Shift of each pixel of an image to its position in another image. Order (row, col), in 1 /
/// kFlowShiftsPerPixel pixels.
struct DenseFlow {
    int rows = 0;
    int cols = 0;
    std::vector<std::int16_t> row_shift;
    std::vector<std::int16_t> col_shift;
};

/// Dense inverse search (Kroeger et al., ECCV 2016) of patches between two images of the same
/// shape. Each patch starts with the flow at half resolution (null: no motion) or, if better, with
/// the shift of a neighbour, and minimises the squared difference after subtraction of the means by
/// gradient descent. Variational refinement is replaced by a bilateral filter of the shifts: a
/// shift that differs by `range_sigma_px` has half the weight. The flow of a pixel is the mean over
/// the patches that contain it, with weights that decrease with their difference at the pixel. The
/// same bits for any SIMD target.
[[nodiscard]] DenseFlow inverse_search(const FlowImage& from, const FlowImage& to,
                                       const DenseFlow* coarser,
                                       const InverseSearchOptions& options);

}  // namespace stipple
