#pragma once

#include <vector>

#include "core/flux_video.h"
#include "decoder/best/collaborative.h"
#include "decoder/best/denoiser.h"
#include "decoder/best/patch_matching.h"
#include "decoder/motion/motion.h"

namespace stipple {

/// The denoiser of `best`: the collaborative filter of patches that are similar in the pilot
/// (`filter_groups`). Keeps motion and groups for the iterations that the options say. Precondition
/// of a call: rows, cols >= kPatchSide; the first one is of iteration 0.
class PatchDenoiser {
  public:
    /// `noise_gain`, unless it is null, receives that of the last iteration (`filter_groups`).
    PatchDenoiser(const CollaborativeOptions& options, bool mosaic, FluxVideo* noise_gain = nullptr)
        : options_(options), mosaic_(mosaic), noise_gain_(noise_gain) {}

    void operator()(const DenoiserInput& input, FluxVideo& result);

  private:
    void find_groups(const DenoiserInput& input);

    CollaborativeOptions options_;
    bool mosaic_;
    FluxVideo* noise_gain_;
    std::vector<MotionField> motion_;
    PatchGroups groups_;
};

}  // namespace stipple
