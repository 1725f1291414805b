#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/colour_filter.h"
#include "core/config.h"
#include "core/geometry.h"
#include "readout/provenance.h"
#include "readout/rig.h"
#include "readout/rig_figures.h"
#include "readout/rig_recorder.h"
#include "readout/sensor_file.h"

namespace stipple {

class PendingOutput;

/// Records footage by the sensors of a rig: `begin`, `expose` for each slot, `finish`.
class RigEmulation {
  public:
    /// A rig by its name or file, with settings "key=value" laid over that, for footage of this
    /// shape. \throws InputError as read_rig and set_up_rig.
    RigEmulation(const std::string& rig, const std::vector<std::string>& settings,
                 FrameShape footage, ColourFilter filter);
    ~RigEmulation();
    RigEmulation(const RigEmulation&) = delete;
    RigEmulation& operator=(const RigEmulation&) = delete;

    /// The reference sensor.
    [[nodiscard]] const SensorSetup& first() const { return setups_.front(); }
    /// Begins the folder of the streams. \throws InputError, DeviceError as PendingOutput.
    void begin(const std::filesystem::path& output, bool force, const FootageOrigin& origin);
    /// \throws DeviceError.
    void expose(std::span<const float> frame);
    [[nodiscard]] std::int64_t slots() const { return slots_; }
    /// Completes the folder. `check` is called before each MiB that is read, and may throw to give
    /// up. \throws InputError as RigRecorder::finish, DeviceError.
    void finish(const std::function<void()>& check);

    /// In the order of the sensors.
    [[nodiscard]] const std::list<RigRecorder>& recorders() const { return recorders_; }
    [[nodiscard]] RigTotals totals() const;

  private:
    Config config_;
    Rig rig_;
    std::vector<SensorSetup> setups_;
    std::unique_ptr<PendingOutput> folder_;
    std::list<RigRecorder> recorders_;
    std::int64_t slots_ = 0;
};

}  // namespace stipple
