#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <variant>

#include "capture/camera.h"

namespace stipple {

/// What becomes of a frame that did not arrive whole. What is missing of it is zero in any case.
enum class IncompletePolicy : std::uint8_t {
    kDrop,  ///< it is left out and counted as our own drop
    kKeep,  ///< it is delivered as it is
    kMask,  ///< it is delivered with the list of its holes; where they are not known, as kDrop
};

struct SessionOptions {
    IncompletePolicy incomplete = IncompletePolicy::kMask;
    /// A camera that sends nothing for so long, and for five frame periods, is opened anew. 0: only
    /// one that is known to be gone. Cameras with TriggerMode On may be silent.
    std::chrono::milliseconds stall{250};
    std::chrono::milliseconds first_frame{2000};  ///< the same, between start and first frame
    bool reconnect = true;
};

/// What became of a session's frames.
struct SessionTotals {
    std::uint64_t frames = 0;      ///< delivered
    std::uint64_t incomplete = 0;  ///< of these, those whose status is not kComplete
    std::array<std::uint64_t, kGapCauseNames.size()> lost{};  ///< missing, by GapCause
    std::uint64_t outages = 0;                                ///< times that the camera was gone
    std::uint64_t repeated = 0;  ///< whole frames that came again, and were left out
};

/// The camera is gone; it is being opened anew.
struct Outage {
    std::string reason;
};

/// It is back, with the settings applied again.
struct Recovery {
    double gone_s = 0;
};

/// What a session has to say; DeviceLost ends it.
using SessionEvent = std::variant<CapturedFrame, NoFrame, Outage, Recovery, DeviceLost>;

/// Frames of a camera, each accounted for: ids unwrapped to 64 bits, gaps with their number and
/// cause, and the camera opened anew when it has gone. For any two frames that are delivered one
/// after the other, b.id = a.id + 1 + b.lost_before.
///
/// The cause of a gap is taken from what the transport counted meanwhile: buffers that were not
/// free, then packets that the network or the socket lost, else it was the camera. Frames lost
/// while the camera was gone are estimated from the frame period before.
/// A frame whose id has been before is a repeat, and left out, or the first of a counter that began
/// anew: the latter if its stamp is newer, or if the next frame follows it.
/// Used from one thread; opening and closing happen in threads of its own.
class CaptureSession {
  public:
    /// Opens the camera with its settings; called again after an outage, from another thread.
    using Opener = std::function<std::unique_ptr<Camera>()>;

    /// Opens and starts. \throws InputError, DeviceError.
    CaptureSession(Opener open, SessionOptions options);
    ~CaptureSession();
    CaptureSession(const CaptureSession&) = delete;
    CaptureSession& operator=(const CaptureSession&) = delete;

    /// Waits for what happens next, not longer than `timeout`.
    [[nodiscard]] SessionEvent next(std::chrono::milliseconds timeout);

    /// A frame that was delivered was not used (a full queue): it is missing before the next one.
    void count_own_drop(const FrameRecord& record) noexcept;

    /// Of the camera as it was opened last.
    [[nodiscard]] const CameraDescription& description() const;
    [[nodiscard]] const FrameLayout& layout() const;
    [[nodiscard]] const SessionTotals& totals() const;
    /// Of all epochs together.
    [[nodiscard]] TransportCounts transport() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
