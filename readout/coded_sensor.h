#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "sensor_model/sensor_params.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// Counts of the emulated chip since its first slot.
struct ReadoutStats {
    std::int64_t slots = 0;  ///< the slot to expose next
    std::uint64_t samples = 0;
    std::uint64_t saturated_samples = 0;  ///< clipped by the full well, or at full scale
    std::uint64_t zero_samples = 0;       ///< at DN 0, where noise is cut off
};

/// The calibration of a sensor for its stream: gain, noise and full well.
[[nodiscard]] Calibration calibration_of(const SensorParams& params);

/// The emulated chip. It collects light slot by slot, and reads the due pixels at the end of each
/// slot in scan order.
class CodedSensor {
  public:
    /// `schedule` must outlive the sensor. The array is reset before `first_slot`; samples of
    /// exposures that began earlier lack light. \throws InputError as `validate`, if the shape is
    /// empty, or if the schedule needs more charge stores than the pixels of the sensor have.
    CodedSensor(const SensorParams& params, FrameShape shape, const ExposureSchedule& schedule,
                std::uint64_t seed, std::int64_t first_slot = 0);
    ~CodedSensor();
    CodedSensor(CodedSensor&&) noexcept;
    CodedSensor& operator=(CodedSensor&&) noexcept;

    /// From the next slot on the sensor has another schedule and other values of its readout: those
    /// of `params` that are in a ReadoutValues; all others must be as before. Nothing is reset.
    /// `schedule` must outlive the sensor. Precondition: no schedule has weights or interleaved
    /// exposures; the next slot is not the first one. \throws InputError as the constructor.
    void switch_to(const SensorParams& params, const ExposureSchedule& schedule);

    /// Exposes the next slot to `frame` (order (plane, row, col), units of FluxVideo) and fills
    /// `packet` with the samples that are due at its end. The same bits for any thread count.
    /// Precondition: frame.size() == shape.sites(), light >= 0 and not NaN.
    void expose(std::span<const float> frame, SamplePacket& packet);
    /// The same light and resets without samples: takes a tenth of the time or so.
    void expose_unread(std::span<const float> frame);

    [[nodiscard]] const ReadoutStats& stats() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
