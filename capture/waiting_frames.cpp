#include "capture/frame_queue.h"

#include <fmt/format.h>

#include <algorithm>

#include "capture/capture_session.h"
#include "core/memory_limit.h"

namespace stipple {
namespace {

double mb(std::size_t bytes) {
    return static_cast<double>(bytes) * 1e-6;
}

}  // namespace

WaitingFrames waiting_frames(const Camera& camera, const WaitingFrames& wanted) {
    constexpr std::size_t kOtherFrames = CaptureSession::kOwnFrames + 1;
    const std::size_t frame = std::max<std::size_t>(camera.layout().payload_bytes(), 1);
    const std::size_t others = camera.buffer_bytes() + kOtherFrames * frame;
    if (others + frame > max_memory())  // asking for a description takes time
        check_memory(others + frame, camera.description().address,
                     fmt::format("the buffers of the camera ({:.1f} MB) and {} frames behind them "
                                 "({:.1f} MB)",
                                 mb(camera.buffer_bytes()), kOtherFrames + 1,
                                 mb((kOtherFrames + 1) * frame)));
    const std::size_t bytes = std::min<std::size_t>(wanted.bytes, max_memory() - others);
    return {std::clamp<std::size_t>(bytes / frame, 1, wanted.frames), bytes};
}

Message short_queue_text(const Camera& camera, std::size_t frames, std::size_t wanted) {
    return fmt::format(
               "{} frames may wait, not {}: so many ({:.1f} MB) and the buffers of the camera "
               "({:.1f} MB) together exceed {:.1f} MB, see ",
               frames, wanted, mb(wanted * camera.layout().payload_bytes()),
               mb(camera.buffer_bytes()), mb(max_memory())) +
           Parameter{"max_memory"};
}

}  // namespace stipple
