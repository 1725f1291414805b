#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/flux_video.h"

namespace stipple {

class SampleNoise;
struct Calibration;
struct Measurements;

/// A frame of a conventional camera: an exposure that all sites share.
struct FrameExposure {
    int first_slot = 0;
    int last_slot = 0;
    int open_slots = 0;
    float centre_slot = 0;  ///< mean of the open ones, by their weights
};

/// The frames of a block in temporal order, if all sites have the same exposures, as in a
/// conventional camera or one with a flutter shutter; none if there is no sample. Samples may be
/// missing. Sites may have different weights, if these have the same centre. Nothing otherwise.
[[nodiscard]] std::optional<std::vector<FrameExposure>> shared_exposures(
    const Measurements& measurements);

/// True if all have the same number of slots and of open slots.
[[nodiscard]] bool equally_long(std::span<const FrameExposure> exposures);

/// The frames as `shared_exposures`, but nothing without samples, and if exposures are weighted or
/// not equally long.
[[nodiscard]] std::optional<std::vector<FrameExposure>> frame_exposures(
    const Measurements& measurements);

/// The samples as those of a camera whose slots are the frames: light per slot, with its noise.
[[nodiscard]] Measurements measurements_of_frames(const Measurements& measurements,
                                                  std::span<const FrameExposure> exposures,
                                                  const SampleNoise& noise);

/// Adds the same light to all open slots of each exposure, or light in proportion to their weights,
/// so that their mean equals its frame.
/// Interpolation between frames of several slots blurs them a second time; this corrects it.
void back_project_residual(const Measurements& measurements,
                           std::span<const FrameExposure> exposures, const FluxVideo& frames,
                           FluxVideo& x);

[[nodiscard]] std::vector<float> centre_slots(std::span<const FrameExposure> exposures);

/// The noise of a frame as light per slot.
[[nodiscard]] SampleNoise noise_of_frames(Calibration calibration,
                                          std::span<const FrameExposure> exposures);

/// The video of all slots from the frames of a conventional camera: interpolated along motion
/// between the centres of their exposures (frame_interpolation.h), then with what the frames lack
/// (frame_exposures.h). If each slot is a frame, the frames themselves. Precondition: at least one
/// frame.
[[nodiscard]] FluxVideo video_of_frames(const Measurements& measurements,
                                        std::span<const FrameExposure> exposures,
                                        const FluxVideo& frames);

}  // namespace stipple
