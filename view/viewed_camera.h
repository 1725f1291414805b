#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "capture/capture_session.h"
#include "capture/frame_queue.h"
#include "capture/frame_sequence.h"
#include "readout/sensor_file.h"
#include "view/recent_slots.h"

namespace stipple {

struct ViewedCameraOptions {
    std::string address;
    /// Opens the camera with these settings.
    std::function<std::unique_ptr<Camera>(const CameraSettings& settings)> open;
    CameraSettings settings = {};
    SessionOptions session = {};
    SensorChoice sensor = {};  ///< that is emulated
    double black_level_dn = 0;
    std::filesystem::path folder = ".";                  ///< of recordings
    std::function<void(const SessionEvent&)> tell = {};  ///< of outages, by another thread
    std::function<void(const Message&)> warn = {};       ///< at the begin
};

/// A running camera that is looked at: its frames, and what the emulated sensor makes of them. A
/// thread receives the frames; those that are recorded never wait for the other threads. Another
/// one emulates the frames that it has the time for. For several threads.
class ViewedCamera {
  public:
    /// Opens and starts the camera. \throws InputError, DeviceError as CaptureSession, FrameLight
    /// and set_up_sensor.
    explicit ViewedCamera(ViewedCameraOptions options);
    /// Ends the recording, if there is one.
    ~ViewedCamera();
    ViewedCamera(const ViewedCamera&) = delete;
    ViewedCamera& operator=(const ViewedCamera&) = delete;

    [[nodiscard]] const std::string& address() const { return options_.address; }
    /// Vendor and model.
    [[nodiscard]] std::string name() const;
    [[nodiscard]] RecentSlots& recent() { return *recent_; }

    /// `frames`, `frames_hz`, `lost` by cause, `incomplete`, `outages`; `skipped`, frames that the
    /// emulation was too slow for; `recording`: null, or `file`, `frames`, `lost`; `events`, the
    /// last 100, each `seconds` since the start and `text`; `ended`: null, or why no frame comes.
    [[nodiscard]] nlohmann::ordered_json status() const;
    /// As `stipple capture features`, of the camera as it runs.
    [[nodiscard]] nlohmann::ordered_json features() const;

    /// Records from now on, to a new file that is named by the time. \throws InputError,
    /// DeviceError as PendingOutput and RecordingWriter; InputError if it records already.
    void record();
    /// \throws InputError if it does not record.
    void stop_recording();
    /// Sets a feature of the camera. \throws InputError, DeviceError as Camera::set.
    void set(const std::string& feature, const std::string& value);

  private:
    struct Recording;

    /// By the thread that receives the frames, between two of them. Waits for it. \throws what
    /// `task` throws; DeviceError if no frames come any more.
    void in_session(std::function<void()> task);
    void run_tasks();
    void receive(const std::stop_token& stop);
    void take(SessionEvent event);
    void take(CapturedFrame frame);
    void emulate();
    void end_recording();
    void add_event(const std::string& text);
    void note_totals();

    ViewedCameraOptions options_;
    mutable std::mutex settings_mutex_;
    CameraSettings settings_;
    CaptureSession session_;
    CameraDescription description_;
    FrameLayout layout_;
    SensorSetup setup_;
    std::unique_ptr<RecentSlots> recent_;
    FrameQueue frames_;  ///< for the emulation
    std::int64_t start_ns_;

    mutable std::mutex mutex_;  ///< of what follows
    std::deque<std::packaged_task<void()>> tasks_;
    bool accepts_tasks_ = true;
    SessionTotals totals_;
    FrameRate rate_;
    std::uint64_t skipped_ = 0;
    std::uint64_t recorded_ = 0;  ///< frames of recording_
    std::uint64_t lost_ = 0;      ///< of them
    std::string file_;            ///< of recording_; empty: none
    std::deque<std::pair<double, std::string>> events_;
    std::string ended_;

    std::unique_ptr<Recording> recording_;      ///< of the receiving thread
    std::vector<std::future<void>> finishing_;  ///< recordings whose frames are being written
    std::jthread receiver_;                     ///< last: they use the other members
    std::jthread emulator_;
};

}  // namespace stipple
