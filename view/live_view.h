#pragma once

#include <mutex>
#include <string>

#include "capture/live_emulator.h"
#include "view/camera_view.h"

namespace stipple {

/// The camera of `capture live`, whose stream is written from its begin to its end.
class LiveView : public CameraView {
  public:
    /// The light of the camera's frames goes through `sensor`, to `file`. `setup` is that of the
    /// sensor and must outlive this.
    LiveView(const LiveCamera& camera, double black_level_dn, const SensorSetup& setup,
             ViewedSensor& sensor, std::string file);

    /// Before each slot, by the thread that emulates.
    void switch_sensor(StreamRecorder& recorder);

    /// Of the emulation so far. Quick: it is called for each frame.
    void note(const LiveEmulation& now);

    [[nodiscard]] const std::string& address() const override { return address_; }
    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] RecentSlots& recent() const override { return recent_; }
    [[nodiscard]] nlohmann::ordered_json status() const override;
    void record() override;
    void stop_recording() override;
    void change_sensor(const std::string& changes) override;

  private:
    std::string address_;
    std::string name_;
    std::string file_;
    ViewedSensor& sensor_;
    mutable RecentSlots recent_;
    CameraEvents events_;
    mutable std::mutex mutex_;
    SessionTotals totals_;
    std::uint64_t frames_ = 0;
    std::uint64_t skipped_ = 0;
    std::optional<double> frames_hz_;
};

}  // namespace stipple
