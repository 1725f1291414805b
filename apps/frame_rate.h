#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "capture/frame_record.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// The rate of a camera's frames, lost ones counted, by the device's stamps or else by their
/// arrival; measured anew after an outage.
class FrameRate {
  public:
    void add(const FrameRecord& record);

    /// That it was measured over.
    [[nodiscard]] double seconds() const;
    /// 0 until some frames have come.
    [[nodiscard]] double hz() const;

  private:
    std::optional<FrameRecord> first_;
    FrameRecord last_;
};

/// What is wrong if a sensor whose slots are shorter or longer gets a frame a slot at this rate;
/// empty if it is right within 2 %, or `frames_hz` is 0.
[[nodiscard]] std::string rate_warning(double frames_hz, const SensorParams& sensor);

}  // namespace stipple
