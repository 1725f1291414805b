#pragma once

#include <atomic>
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
#include "readout/emulator.h"
#include "readout/sensor_file.h"
#include "view/camera_view.h"

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

/// `settings` with this value of a feature, set last.
[[nodiscard]] CameraSettings with_setting(CameraSettings settings, const std::string& feature,
                                          const std::string& value);

/// A running camera that is looked at: its frames, and what the emulated sensor makes of them. A
/// thread receives the frames; those that are recorded never wait for the other threads. Another
/// one emulates the frames that it has the time for. For several threads.
class ViewedCamera : public CameraView {
  public:
    /// Opens and starts the camera. \throws InputError, DeviceError as CaptureSession, FrameLight
    /// and set_up_sensor.
    explicit ViewedCamera(ViewedCameraOptions options);
    /// Ends the recording, if there is one.
    ~ViewedCamera() override;

    [[nodiscard]] const std::string& address() const override { return options_.address; }
    [[nodiscard]] std::string name() const override;
    [[nodiscard]] RecentSlots& recent() const override { return *recent_; }
    [[nodiscard]] nlohmann::ordered_json status() const override;

    /// To a new file that is named by the time. \throws InputError, DeviceError as PendingOutput
    /// and RecordingWriter.
    void record() override;
    void stop_recording() override;
    void change_sensor(const std::string& changes) override;
    /// As it was changed.
    [[nodiscard]] SensorChoice sensor() const { return sensor_->choice(); }
    /// With what `set` has changed.
    [[nodiscard]] CameraSettings settings() const;
    [[nodiscard]] bool records() const;
    /// Sets a feature of the camera. \throws InputError, DeviceError as CaptureSession::set.
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
    /// Returns the first slot after the switch.
    std::int64_t switch_to(Emulator& emulator, const SensorSetup& next);
    void end_recording();

    ViewedCameraOptions options_;
    mutable std::mutex settings_mutex_;
    CameraSettings settings_;
    CaptureSession session_;
    CameraDescription description_;
    FrameLayout layout_;
    std::optional<SensorSetup> setup_;
    std::unique_ptr<ViewedSensor> sensor_;
    std::unique_ptr<RecentSlots> recent_;
    FrameQueue frames_;  ///< for the emulation
    CameraEvents events_;

    std::atomic<bool> ready_ = false;  ///< frames before are discarded
    mutable std::mutex mutex_;         ///< of what follows
    std::deque<std::packaged_task<void()>> tasks_;
    bool accepts_tasks_ = true;
    SessionTotals totals_;
    FrameRate rate_;
    std::uint64_t skipped_ = 0;
    std::uint64_t recorded_ = 0;  ///< frames of recording_
    std::uint64_t lost_ = 0;      ///< of them
    std::string file_;            ///< of recording_; empty: none
    std::string ended_;

    std::unique_ptr<Recording> recording_;      ///< of the receiving thread
    std::vector<std::future<void>> finishing_;  ///< recordings whose frames are being written
    std::jthread receiver_;                     ///< last: they use the other members
    std::jthread emulator_;
};

}  // namespace stipple
