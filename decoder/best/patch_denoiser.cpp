#include "decoder/best/patch_denoiser.h"

#include <algorithm>

#include "decoder/best/patch_kernels.h"

namespace stipple {

void PatchDenoiser::operator()(const DenoiserInput& input, FluxVideo& result) {
    find_groups(input);
    const bool last = input.iteration + 1 == options_.iterations;
    filter_groups(input.noisy, input.pilot, groups_, input.sigma,
                  {result, last ? noise_gain_ : nullptr});
}

void PatchDenoiser::find_groups(const DenoiserInput& input) {
    const FrameShape shape = input.noisy.shape();
    if (input.iteration % options_.motion_every == 0 &&
        std::min(shape.rows, shape.cols) >= kMinMotionSide)
        motion_ = estimate_motion(input.light, {});
    if (input.iteration % options_.match_every != 0) return;
    // The grid moves, so that the seams between patches do not stay in one place.
    const int step = options_.patch_stride;
    const int offset = input.iteration / options_.match_every * (step / 2 + 1) % step;
    const bool near = mosaic_ && input.iteration < options_.mosaic.near_iterations;
    groups_ = match_patches(input.pilot, {shape, step, offset}, motion_,
                            near ? options_.mosaic.near : options_.matching);
}

}  // namespace stipple
