#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/flux_video.h"
#include "decoder/pixel_response.h"

namespace stipple {

struct Measurements;

/// An exposure that all sites share: a frame of a conventional camera.
struct FrameExposure {
    int first_slot = 0;
    int last_slot = 0;
    int open_slots = 0;
    float centre_slot = 0;  ///< mean of the open ones
};

/// The frames of a block, in order, if no two sites expose at different times: a shutter for all,
/// as in a conventional camera or one that flutters. Samples may be missing. Nothing otherwise, and
/// where each slot is a frame, so that there is nothing between frames.
[[nodiscard]] std::optional<std::vector<FrameExposure>> frame_exposures(
    const Measurements& measurements);

/// The same samples as those of a camera whose slots are the frames: light per slot, with the noise
/// that each has.
[[nodiscard]] Measurements measurements_of_frames(const Measurements& measurements,
                                                  std::span<const FrameExposure> exposures,
                                                  const SampleNoise& noise);

/// Adds to the open slots of each exposure what their mean lacks of its frame: what lies between
/// frames that show the mean of several slots each is that of both, and so blurred twice.
void add_what_frames_lack(const Measurements& measurements,
                          std::span<const FrameExposure> exposures, const FluxVideo& frames,
                          FluxVideo& x);

[[nodiscard]] std::vector<float> centre_slots(std::span<const FrameExposure> exposures);

/// The noise of a frame as light per slot.
[[nodiscard]] SampleNoise noise_of_frames(Calibration calibration,
                                          std::span<const FrameExposure> exposures);

}  // namespace stipple
