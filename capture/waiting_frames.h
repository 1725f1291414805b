#pragma once

#include <cstddef>
#include <limits>

#include "capture/camera.h"
#include "core/message.h"

namespace stipple {

/// Frames that may wait behind a camera for a slower consumer.
struct WaitingFrames {
    std::size_t frames = std::numeric_limits<std::size_t>::max();
    std::size_t bytes = std::numeric_limits<std::size_t>::max();
};

/// The wanted ones, or fewer: with the buffers of the open camera and the frames that are not in
/// the queue (of the session, and one in use) they take no more than `max_memory`. \throws
/// InputError if that leaves no room for a single frame.
[[nodiscard]] WaitingFrames waiting_frames(const Camera& camera, const WaitingFrames& wanted);

/// Warns that fewer frames may wait than were wanted.
[[nodiscard]] Message short_queue_text(const Camera& camera, std::size_t frames,
                                       std::size_t wanted);

}  // namespace stipple
