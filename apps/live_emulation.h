#pragma once

#include <cstdint>
#include <exception>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/arguments/camera.h"
#include "apps/arguments/preview.h"
#include "apps/arguments/run_options.h"
#include "apps/live_preview.h"
#include "capture/frame_light.h"
#include "capture/frame_rate.h"
#include "capture/live_camera.h"
#include "core/duration_histogram.h"
#include "readout/sensor_file.h"
#include "readout/stream_recorder.h"

namespace stipple {

/// What `stipple capture live` was asked for.
struct LiveArguments {
    CameraArguments camera;
    SessionOptions session{.incomplete = IncompletePolicy::kKeep};  ///< they are held, and counted
    SensorChoice sensor;
    std::string output;
    double black_level_dn = 0;
    CaptureLimits limits;
    PreviewArguments preview;
    std::size_t queue_frames = 64;
    double late_after_slots = 2;
};

/// A camera's frames through the emulated sensor as they come, a slot each. Where frames are
/// missing or incomplete, the one before stands in, so that each slot keeps its time.
class LiveEmulation {
  public:
    /// Opens camera and output. \throws InputError, DeviceError.
    LiveEmulation(const LiveArguments& arguments, const RunOptions& run);

    /// Until the frames or seconds are reached, a signal asks to stop, or the camera is lost.
    void run(const RunOptions& run);
    /// Stops the camera and puts the stream in place, as far as it goes. \throws DeviceError if the
    /// camera was lost or the disk is full.
    void finish();

    [[nodiscard]] nlohmann::ordered_json json() const;
    [[nodiscard]] std::string text() const;

  private:
    [[nodiscard]] bool wants_more(double seconds) const;
    void take(const CapturedFrame& frame);
    [[nodiscard]] std::uint64_t lost_to_hold(std::uint64_t lost);
    void hold_missing(const FrameRecord& record);
    void expose(std::int64_t arrival_ns);
    void compare_rates();
    [[nodiscard]] std::optional<double> slots_per_s() const;
    void put_in_place();

    struct LateSlot {
        std::int64_t slot;
        std::int64_t arrival_ns;
        double latency_us;
    };

    const LiveArguments& arguments_;
    LiveCamera camera_;
    FrameLight to_light_;
    SensorSetup setup_;
    StreamRecorder recorder_;
    std::optional<LivePreview> preview_;
    SessionTotals totals_;  ///< from the first slot to the last
    std::vector<float> light_;
    DurationHistogram latencies_;  ///< of each frame
    std::uint64_t held_slots_ = 0;
    std::uint64_t unheld_slots_ = 0;  ///< left out: too many beside the frames
    std::uint64_t late_slots_ = 0;
    std::vector<LateSlot> late_;  ///< the first of them
    FrameRate rate_;
    bool rates_compared_ = false;
    std::exception_ptr failure_;      ///< of the disk, or no memory
    std::int64_t first_done_ns_ = 0;  ///< when the first slot was in the stream
    std::int64_t last_done_ns_ = 0;
    std::optional<DeviceLost> end_;  ///< of the frames
};

}  // namespace stipple
