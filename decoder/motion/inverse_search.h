#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stipple {

/// Pixels that are repeated around the image of a flow, so that patches may leave it.
inline constexpr int kFlowBorder = 16;

/// Side of the patches that the flow follows, in pixels.
inline constexpr int kFlowPatchSide = 8;

/// One level of an image's pyramid, 8 bits; kFlowBorder pixels more can be read on each side.
struct FlowImage {
    const std::uint8_t* pixels = nullptr;
    std::ptrdiff_t stride = 0;  ///< between rows
    int rows = 0;               ///< at least kFlowPatchSide
    int cols = 0;
};

/// Where each pixel of an image is found in another one: at its place plus the shift.
/// Order (row, col), in 1 / kFlowShiftsPerPixel pixels.
struct DenseFlow {
    int rows = 0;
    int cols = 0;
    std::vector<std::int16_t> row_shift;
    std::vector<std::int16_t> col_shift;
};
inline constexpr int kFlowShiftsPerPixel = 64;

struct InverseSearchOptions {
    int patch_stride_px = 4;       ///< between patches
    float range_sigma_px = 0.03F;  ///< shifts that differ by this count half when they are averaged
};

/// Follows patches from one image to another of the same shape by dense inverse search (Kroeger et
/// al., ECCV 2016): each begins with the flow at half the resolution (null: at rest) or, if better,
/// where its neighbours went, and descends the squared difference less that of the means. In place
/// of variational refinement, shifts are averaged with those around that differ little. A pixel
/// moves as the patches that cover it, each with a weight that falls with its difference there. The
/// same bits for any SIMD target.
[[nodiscard]] DenseFlow inverse_search(const FlowImage& from, const FlowImage& to,
                                       const DenseFlow* coarser,
                                       const InverseSearchOptions& options);

}  // namespace stipple
