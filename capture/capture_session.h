#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "capture/camera.h"
#include "core/named_value.h"

namespace stipple {

/// Treatment of incomplete frames. Missing bytes are zero in any case.
enum class IncompletePolicy : std::uint8_t {
    kDrop,  ///< dropped, counted as lost by what made it incomplete
    kKeep,  ///< delivered without the list of holes
    kMask,  ///< delivered with the list of its holes; if they are unknown, as kDrop
};

inline constexpr auto kIncompletePolicies =
    std::to_array<NamedValue<IncompletePolicy>>({{"drop", IncompletePolicy::kDrop},
                                                 {"keep", IncompletePolicy::kKeep},
                                                 {"mask", IncompletePolicy::kMask}});

struct SessionOptions {
    IncompletePolicy incomplete = IncompletePolicy::kMask;
    /// A camera that is silent for this time and for five frame periods is opened again. 0: no
    /// limit. Cameras with TriggerMode On may be silent.
    std::chrono::milliseconds stall{250};
    static constexpr std::chrono::milliseconds kMaxStall{3'600'000};
    std::chrono::milliseconds first_frame{2000};  ///< the limit between start and first frame
    bool reconnect = true;
};

/// How long to capture; 0: until stopped.
struct CaptureLimits {
    std::uint64_t frames = 0;
    double seconds = 0;

    /// True if a limit is reached.
    [[nodiscard]] bool reached(std::uint64_t taken_frames, double elapsed_s) const {
        return (frames > 0 && taken_frames >= frames) || (seconds > 0 && elapsed_s >= seconds);
    }
    /// The frames that there will be, if that is known.
    [[nodiscard]] std::optional<std::int64_t> total() const {
        return frames == 0 ? std::nullopt : std::optional(static_cast<std::int64_t>(frames));
    }
};

/// Counts of the frames of a session.
struct SessionTotals {
    std::uint64_t frames = 0;                ///< delivered
    std::uint64_t incomplete = 0;            ///< of these with a status other than kComplete
    LostFrames lost{};                       ///< missing, by GapCause
    std::uint64_t missing_before_first = 0;  ///< of these, before the first delivered frame
    std::uint64_t outages = 0;               ///< number of times that the camera was lost
    std::uint64_t repeated = 0;              ///< complete frames that came a second time, left out
};

/// The camera is lost; the session is reopening it.
struct Outage {
    std::string reason;
};

/// The camera is back, with its settings.
struct Recovery {
    double gone_s = 0;
};

/// Event of a session; DeviceLost is the last one.
using SessionEvent = std::variant<CapturedFrame, NoFrame, Outage, Recovery, DeviceLost>;

/// Frames of a camera with complete accounting: ids unwrapped to 64 bits, gaps with the number and
/// cause of lost frames, and reconnection when the camera is lost. For consecutive delivered frames
/// a and b, b.id = a.id + 1 + b.lost_before.
///
/// The counters of the transport decide the cause of a gap, in this order: no free buffer
/// (kHostUnderrun), losses of network or socket (kTransport), none (kDevice). The number of frames
/// lost during an outage is estimated from the earlier frame period. Frames lost before the first
/// one that arrives count too, if its id tells (frames_before_first); its id is their number.
/// A frame with an old id is the first of a restarted counter if its stamp is newer, or if the next
/// frame follows it. Otherwise it is a repeat, and left out.
/// Used from one thread; other threads open and close the camera.
class CaptureSession {
  public:
    /// Opens the camera with its settings. Called again after an outage, from another thread.
    using Opener = std::function<std::unique_ptr<Camera>()>;

    /// How many frames of an open camera the caller holds at a time, and gives back.
    using HeldFrames = std::function<std::size_t(const Camera&)>;

    /// Opens and starts. In between, memory for the payloads of `held` frames is allocated: no
    /// later frame of this layout needs more. \throws InputError, DeviceError, and as `held`.
    CaptureSession(Opener open, SessionOptions options, const HeldFrames& held = {});
    ~CaptureSession();
    CaptureSession(const CaptureSession&) = delete;
    CaptureSession& operator=(const CaptureSession&) = delete;

    /// Waits for the next event, at most `timeout`.
    [[nodiscard]] SessionEvent next(std::chrono::milliseconds timeout);

    /// Frames that the session itself holds at most: the one being received, and two whose order
    /// is in doubt.
    static constexpr std::size_t kOwnFrames = 3;
    /// The memory of a payload is free for a later frame. Any thread may call it.
    void give_back(std::vector<std::uint8_t>&& payload);
    /// Number of payloads that this memory was not enough for.
    [[nodiscard]] std::uint64_t late_allocations() const;

    /// Sets a feature of the camera, as Camera::set. \throws InputError also for a feature that
    /// changes the layout of frames; DeviceError if the camera is lost.
    void set(const std::string& feature, const std::string& value);

    /// A delivered frame was dropped by a full queue: it counts as missing before the next one.
    void count_queue_drop(const FrameRecord& record) noexcept;

    /// Of the camera when it was last opened.
    [[nodiscard]] const CameraDescription& description() const;
    [[nodiscard]] const FrameLayout& layout() const;
    [[nodiscard]] const SessionTotals& totals() const;
    /// Sum over all epochs.
    [[nodiscard]] TransportCounts transport() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
