#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>

#include "capture/capture_session.h"
#include "readout/sensor_switch.h"
#include "view/recent_slots.h"

namespace stipple {

/// The last 100 things that have happened to a camera. For several threads.
class CameraEvents {
  public:
    void add(const std::string& text);
    /// An outage, a recovery or the end.
    void add(const SessionEvent& event);
    /// Each `seconds` since the start, and `text`.
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    mutable std::mutex mutex_;
    std::deque<std::pair<double, std::string>> events_;
};

/// The lost frames of all causes.
[[nodiscard]] std::uint64_t all_lost(const LostFrames& lost);

/// The emulated sensor of a running camera, which may change between two slots. For several
/// threads.
class ViewedSensor {
  public:
    /// `fixed`: why it cannot change; empty if the sensor can. `setup`, of `choice` for footage
    /// with this mosaic, must outlive this.
    ViewedSensor(SensorChoice choice, const SensorSetup& setup, ColourFilter mosaic,
                 std::string fixed = {});

    /// As SensorControl::change; `events` are told. \throws InputError if it cannot change.
    void change(const std::string& changes, CameraEvents& events);
    /// As SensorControl::apply, for a sensor that has exposed `slots` slots.
    void apply(std::int64_t slots,
               const std::function<std::int64_t(const SensorSetup&)>& switch_to);
    void end() { control_.end(); }
    [[nodiscard]] SensorChoice choice() const { return control_.choice(); }
    /// `sensor` of CameraView::status.
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    std::string fixed_;
    SensorControl control_;
};

/// What a page shows of a running camera. For several threads.
class CameraView {
  public:
    virtual ~CameraView() = default;
    CameraView(const CameraView&) = delete;
    CameraView& operator=(const CameraView&) = delete;

    [[nodiscard]] virtual const std::string& address() const = 0;
    /// Vendor and model.
    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual RecentSlots& recent() const = 0;
    /// `frames`, `frames_hz`, `lost` by cause, `incomplete`, `outages`; `skipped`, frames that the
    /// emulation was too slow for; `recording`: null, or `file`, `frames`, `lost` and whether the
    /// page may `stop` it; `sensor`: its `schedule`, `seed`, and `fixed`: null, or why it cannot
    /// change; `events`, as CameraEvents; `ended`: null, or why no frame comes.
    [[nodiscard]] virtual nlohmann::ordered_json status() const = 0;
    /// As `stipple capture features`, of the camera as it runs. \throws as camera_features.
    [[nodiscard]] nlohmann::ordered_json features() const;

    /// Records from now on. \throws InputError if it records already; as the output.
    virtual void record() = 0;
    /// \throws InputError if it does not record, or the page may not stop it.
    virtual void stop_recording() = 0;
    /// Changes the emulated sensor between two slots. \throws InputError, DeviceError as
    /// ViewedSensor::change.
    virtual void change_sensor(const std::string& changes) = 0;

  protected:
    CameraView() = default;
};

}  // namespace stipple
