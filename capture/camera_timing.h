#pragma once

#include <chrono>
#include <cstdint>

#include "capture/camera.h"

namespace stipple {

/// The shortest frame period that the settings of a camera allow; 0 if they do not tell.
[[nodiscard]] std::chrono::nanoseconds nominal_period(const CameraDescription& camera);

/// Whether triggers decide when a frame comes.
[[nodiscard]] bool waits_for_triggers(const CameraDescription& camera);

/// Number of frames that a camera has sent before `first`, the first one that arrived. Some cameras
/// begin with another id, although the standard says which. So the difference of the ids counts
/// only if the camera had the time for so many frames since its start, by its nominal period (10 %
/// tolerance). It is 0 if the period is not known, and if triggers decide.
[[nodiscard]] std::uint64_t frames_before_first(const CameraDescription& camera,
                                                const StreamStart& start, const FrameRecord& first);

}  // namespace stipple
