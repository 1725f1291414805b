#pragma once

#include <optional>
#include <span>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/conventional/frame_decoding.h"

namespace stipple {

class Config;

/// Options of the method `zhang2009`; docs/decoder_conventional.md has the formulas.
struct Zhang2009Options {
    int reach_frames = 5;      ///< of the flow that a patch follows, before and after
    int patch_px = 6;          ///< side of a patch
    int step_px = 3;           ///< between reference patches
    float max_distance = 3;    ///< mean square difference to the reference, in noise variances
    int min_confidence = 100;  ///< of the flow, 0..255
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Zhang2009Options& options);

/// Denoising along optical flow: the patches that the flow leads to are a stack, whose principal
/// components above the noise are kept (Zhang, Vaddadi, Jin, Nayar, CVPR 2009, with the flow of a
/// video for the disparities of views). Frames smaller than a patch are not filtered. The same bits
/// for any thread count. Returns nothing if `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> denoise_along_flow(
    const DeliveredFrames& frames, const Zhang2009Options& options,
    const ProgressCallback& progress = [](double) { return true; });

/// Denoises a stack of patches (order (patch, value)) in place: keeps the mean patch and the
/// principal components whose variance exceeds the largest eigenvalue of noise of standard
/// deviation `sigma` (Marchenko and Pastur 1967), each by its Wiener factor. Returns the sum of the
/// squared factors, that of the mean included. Precondition: `patches` >= 1 divides the length.
[[nodiscard]] float filter_patch_stack(std::span<float> stack, int patches, float sigma);

}  // namespace stipple
