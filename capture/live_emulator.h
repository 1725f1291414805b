#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/capture_session.h"
#include "capture/frame_light.h"
#include "capture/frame_sequence.h"
#include "capture/live_camera.h"
#include "core/duration_histogram.h"
#include "readout/provenance.h"
#include "readout/stream_recorder.h"

namespace stipple {

/// Missing frames that were not replaced: too many in proportion to those that came.
struct LeftOut {
    std::uint64_t missing = 0;    ///< before one frame
    std::uint64_t held = 0;       ///< of these
    std::int64_t first_slot = 0;  ///< from which on slots come too early
};

/// Text of a warning about it; `address` is that of the camera.
[[nodiscard]] std::string left_out_text(const std::string& address, const LeftOut& left_out);

/// What became of a slot.
struct LiveSlot {
    std::span<const std::uint8_t> payload;  ///< of the frame; empty if the one before is repeated
    std::span<const SamplePacket> packets;
    std::int64_t arrival_ns = 0;  ///< when the light came (CLOCK_MONOTONIC)
};

struct LiveEmulatorOptions {
    CaptureLimits limits = {};
    double late_after_slots = 2;  ///< from frame in to packets out
    /// Before each slot; may be empty.
    std::function<void(StreamRecorder& recorder)> before_slot = {};
    /// Given each slot; may be empty.
    std::function<void(const LiveSlot& slot)> show = {};
    /// Told the first time that frames are left out; may be empty.
    std::function<void(const LeftOut&)> tell = {};
};

/// A slot whose packets came too late.
struct LateSlot {
    std::int64_t slot;
    std::int64_t arrival_ns;  ///< of its frame
    double latency_us;
};

/// What has become of a camera's frames.
struct LiveEmulation {
    DurationHistogram latencies;  ///< from frame in to packets out, of each whole frame
    SessionTotals totals;         ///< from the first slot to the last; missing_before_first apart
    FrameRate rate;
    std::uint64_t held_slots = 0;     ///< repetitions of the previous frame
    std::uint64_t dropped_slots = 0;  ///< of these, without samples, as the emulation was too slow
    std::uint64_t unheld_slots = 0;   ///< missing and not replaced
    std::uint64_t late_slots = 0;
    std::vector<LateSlot> late;              ///< the first 1000
    std::optional<double> slots_per_second;  ///< once it has ended; nothing of a single slot
    std::optional<DeviceLost> end;           ///< of the frames
    std::exception_ptr failure;              ///< of the disk (DeviceError), or no memory
};

/// A camera's frames through the emulated sensor as they come, a slot each. Where frames are
/// missing or incomplete, the previous one is repeated, so that each slot keeps its time. Where the
/// full queue dropped frames, such slots have no samples, so that the emulation catches up.
class LiveEmulator {
  public:
    /// Asked before each wait for a frame, every 50 ms at least; false ends the emulation.
    using Observer = std::function<bool(const LiveEmulation&)>;

    /// `camera` and `recorder` must outlive it; `to_light` is made for the camera's layout, the
    /// recorder's setup for its light.
    LiveEmulator(LiveCamera& camera, FrameLight to_light, StreamRecorder& recorder,
                 LiveEmulatorOptions options);

    /// Takes frames until a limit is reached, `progress` says no or the camera is lost. The stream
    /// is the caller's to finish. Called once.
    [[nodiscard]] LiveEmulation run(const Observer& progress);

  private:
    void end(std::optional<DeviceLost> lost);
    void take(const CapturedFrame& frame);
    [[nodiscard]] std::uint64_t lost_to_hold(std::uint64_t lost);
    void hold_missing(const FrameRecord& record);
    void expose(const LiveSlot& slot, bool is_read = true);

    LiveCamera& camera_;
    FrameLight to_light_;
    StreamRecorder& recorder_;
    LiveEmulatorOptions options_;
    std::vector<float> light_;
    GapFiller filler_;
    LiveEmulation result_;
    std::int64_t first_done_ns_ = 0;  ///< when the first slot was in the stream
    std::int64_t last_done_ns_ = 0;
};

/// What the stream of a camera says of where its light comes from: no address, no time. A replay
/// has the origin of its file. `check` as in origin_of. \throws InputError as origin_of.
[[nodiscard]] FootageOrigin live_origin(const std::string& address, const LiveCamera& camera,
                                        double black_level_dn, const std::function<void()>& check);

}  // namespace stipple
