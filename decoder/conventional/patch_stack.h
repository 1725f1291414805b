#pragma once

#include <span>

namespace stipple {

/// Denoises a stack of patches (order (patch, value)) in place: keeps the mean patch and the
/// principal components whose variance exceeds the largest eigenvalue of noise of standard
/// deviation `sigma` (Marchenko and Pastur 1967), each by its Wiener factor. Returns the sum of the
/// squared factors, that of the mean included. Precondition: `patches` >= 1 divides the length.
[[nodiscard]] float filter_patch_stack(std::span<float> stack, int patches, float sigma);

}  // namespace stipple
