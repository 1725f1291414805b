#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "capture/camera.h"

namespace stipple {

/// What a scripted camera does next: it delivers something, or is silent for as long as it is
/// asked.
struct ScriptedStep {
    std::function<Arrival()> arrival;  ///< empty: silence until the end of time
    TransportCounts counts;            ///< what its transport has counted by then
};

/// The frame layout of scripted cameras: 4 x 2 pixels, Mono8.
inline FrameLayout scripted_layout(int width = 4) {
    FrameLayout layout;
    layout.format = pixel_format_named("Mono8");
    layout.width = width;
    layout.height = 2;
    layout.stride_bytes = static_cast<std::size_t>(width);
    return layout;
}

/// A frame that arrives `ms` milliseconds after the first of an imagined clock.
inline CapturedFrame scripted_frame(std::uint64_t wire_id, std::int64_t ms = 0) {
    CapturedFrame frame;
    frame.record.wire_id = wire_id;
    frame.record.host_monotonic_ns = ms * 1'000'000;
    frame.record.layout = scripted_layout();
    frame.payload.assign(8, static_cast<std::uint8_t>(wire_id));
    frame.record.bytes_received = 8;
    return frame;
}

/// A camera whose frames are written down.
class ScriptedCamera : public Camera {
  public:
    explicit ScriptedCamera(std::deque<ScriptedStep> steps, CameraDescription description = {})
        : steps_(std::move(steps)), description_(std::move(description)) {}
    ~ScriptedCamera() override {
        if (on_close) on_close();
    }

    [[nodiscard]] CameraDescription description() const override { return description_; }
    [[nodiscard]] FrameLayout layout() const override { return scripted_layout(); }
    [[nodiscard]] std::uint64_t wire_id_period() const override { return 65535; }
    [[nodiscard]] std::optional<StreamStart> stream_start() const override { return begin; }
    [[nodiscard]] TransportCounts counts() const override { return counts_; }
    void start() override {}
    [[nodiscard]] Arrival wait(std::chrono::milliseconds timeout) override {
        if (steps_.empty() || !steps_.front().arrival) {
            std::this_thread::sleep_for(timeout);  // what a silent camera's wait does
            return NoFrame{};
        }
        const ScriptedStep step = steps_.front();
        steps_.pop_front();
        counts_ = step.counts;
        return step.arrival();
    }
    void stop() noexcept override {}

    std::function<void()> on_close;
    std::optional<StreamStart> begin;

  private:
    std::deque<ScriptedStep> steps_;
    CameraDescription description_;
    TransportCounts counts_;
};

/// A step that delivers a frame.
inline ScriptedStep arrives(const CapturedFrame& frame, const TransportCounts& counts = {}) {
    return {[frame] { return Arrival(frame); }, counts};
}

inline ScriptedStep is_lost(const std::string& reason, bool at_end = false) {
    return {[=] { return Arrival(DeviceLost{reason, at_end}); }, {}};
}

}  // namespace stipple
