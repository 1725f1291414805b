#pragma once

#include <span>
#include <vector>

#include "core/geometry.h"

namespace stipple {

/// Light of a clip, order (slot, plane, row, col).
struct Clip {
    std::span<const float> light;
    int frames = 0;
    FrameShape shape;
};

/// How a camera that moves sees a part of a clip: slot i is the mean light of the frames from
/// first_frame + i `frames_per_slot` to first_frame + (i + 1) `frames_per_slot`, each constant for
/// its time; its upper left corner lies at (top[i], left[i]), between pixels by bilinear
/// interpolation. `contrast` is a power of the light (2 doubles the stops), `light` a factor after
/// it.
///
/// Not modelled: motion between two frames, motion of the camera during a slot.
struct MovingCrop {
    double first_frame = 0;
    double frames_per_slot = 1;
    std::vector<double> top;   ///< pixels, one for each slot
    std::vector<double> left;  ///< likewise
    double light = 1;
    double contrast = 1;
};

/// The slots of the crop, each of `shape`, order (slot, plane, row, col). The same bits for any
/// number of threads. \throws InputError if the crop reaches beyond the clip or is no part of it:
/// other planes, numbers that are not finite, a speed, light or contrast that is not above 0.
[[nodiscard]] std::vector<float> take_crop(const Clip& clip, const MovingCrop& crop,
                                           FrameShape shape);

}  // namespace stipple
