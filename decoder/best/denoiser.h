#pragma once

#include <functional>

#include "core/flux_video.h"

namespace stipple {

struct CollaborativeOptions;

/// An estimate of a block, to be denoised. The videos have one shape.
struct DenoiserInput {
    int iteration = 0;       ///< of the block, from 0
    float sigma = 0;         ///< standard deviation of the noise of `noisy`, equal everywhere
    const FluxVideo& light;  ///< the estimate, flux
    const FluxVideo& noisy;  ///< the same by stabilise_variance (pixel_transforms.h)
    const FluxVideo& pilot;  ///< the last result; in the first iteration `noisy`
};

/// Takes the noise out of `input.noisy`. All of `result` is written; it has the shape of the input
/// and is none of its videos. What the function throws ends the decoding. It is called in the
/// thread that decodes, and never twice at once.
using Denoiser = std::function<void(const DenoiserInput& input, FluxVideo& result)>;

/// The denoiser of one block, called before its first iteration. `mosaic`: two of three voxels are
/// without samples.
using DenoiserMaker = std::function<Denoiser(const CollaborativeOptions& options, bool mosaic)>;

}  // namespace stipple
