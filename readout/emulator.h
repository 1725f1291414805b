#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "readout/coded_sensor.h"
#include "readout/sensor_file.h"
#include "readout/timing/readout_cost.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// The stream header of this sensor; `provenance` as `provenance_of` writes it, or empty.
[[nodiscard]] StreamHeader stream_header_of(const SensorSetup& setup, std::string provenance);

/// A sensor that turns light into the packets of a stream, slot by slot.
class Emulator {
  public:
    /// `setup` must outlive the emulator. The array is reset before `first_slot`; samples of
    /// exposures that began earlier lack light (lead_in_slots).
    explicit Emulator(const SensorSetup& setup, std::int64_t first_slot = 0);

    /// From the next slot on, not the first one, the sensor has the schedule of `next` and the
    /// values of its readout. Fixed patterns and noise remain those of the first setup. With a
    /// timing the slot before may be longer now (ReadoutCost). \throws InputError as check_switch.
    void switch_to(const SensorSetup& next);

    /// Exposes the next slot to `frame` (of the footage's shape, order (plane, row, col)), behind
    /// the grey mask of the slot if the schedule has weights: its photons are counted. The
    /// packets of the slot, valid until the next call: one, or two if the last rows do not fit the
    /// slot and are dropped.
    [[nodiscard]] std::span<const SamplePacket> expose(std::span<const float> frame);
    /// The same for a sensor without timing whose readout is known: `slot`.
    [[nodiscard]] std::span<const SamplePacket> expose(std::span<const float> frame,
                                                       const SlotCost& slot);
    /// The same for a slot whose samples are all dropped, which takes a fraction of the time. Its
    /// packet, valid until the next call.
    [[nodiscard]] const SamplePacket& expose_unread(std::span<const float> frame);

    [[nodiscard]] const SensorSetup& setup() const { return setup_; }
    [[nodiscard]] bool switched() const { return !schedules_.empty(); }
    /// Transmittances of the filters before the pixels, as responsivities; empty if there are none.
    [[nodiscard]] const CalibrationTile& filters() const { return filters_; }
    [[nodiscard]] const ReadoutStats& stats() const { return sensor_.stats(); }
    /// Fraction of the light that is collected in steady slots; NaN after a switch.
    [[nodiscard]] double light_throughput() const;
    /// Fraction of the light on the array since slot 0 that the samples hold. Less than the light
    /// throughput by exposures that began before slot 0, exposures under way, and dropped rows. NaN
    /// before slot 0 and after a switch. Precondition: the first slot was 0.
    [[nodiscard]] double light_read() const;
    /// Of the readout; null if the sensor has no timing.
    [[nodiscard]] const ReadoutCost* readout_cost() const {
        return readout_cost_ ? &*readout_cost_ : nullptr;
    }

  private:
    [[nodiscard]] const ExposureSchedule& schedule() const {
        return switched() ? schedules_.back() : setup_.schedule.schedule;
    }
    [[nodiscard]] std::span<const float> light_on_pixels(std::span<const float> frame);
    [[nodiscard]] std::span<const SamplePacket> split_at_overrun(const SlotCost& slot);

    const SensorSetup& setup_;
    std::deque<ExposureSchedule> schedules_;  ///< since the first switch
    CalibrationTile filters_;
    CodedSensor sensor_;
    std::optional<ReadoutCost> readout_cost_;
    std::array<SamplePacket, 2> packets_;
    double dropped_light_ = 0;            ///< as `light_due`, of rows that were due
    std::map<std::int64_t, int> unread_;  ///< how many slots of a kind (`kind_of_slot`) are unread
    std::vector<float> mosaic_;           ///< of light in colour behind colour filters
    std::vector<float> masked_;           ///< light behind a grey mask
};

/// Why a sensor cannot switch at all: it drops late rows, weights, interleaved exposures. Empty if
/// it can.
[[nodiscard]] std::string no_switch_text(const SensorSetup& setup);

/// \throws InputError if a sensor cannot switch from one setup to the other between two slots: it
/// drops late rows, a schedule has weights or interleaved exposures, or other parameters differ
/// than those of ReadoutValues. `slot` is for the message.
void check_switch(const SensorSetup& from, const SensorSetup& to, std::int64_t slot);

/// What such a switch is in a stream; its slot and number are set by the StreamWriter.
[[nodiscard]] ScheduleSwitch switch_of(const SensorSetup& to);

/// Slots that a sensor must be exposed after a reset until its samples are those of a sensor that
/// was exposed since slot 0, bit by bit (docs/scaling.md). `--part` of `emulate` emulates so many
/// before its first slot, and discards their samples.
/// \throws InputError if there is no such number: lag and blooming carry light from one exposure
/// to the next without end.
[[nodiscard]] std::int64_t lead_in_slots(const SensorSetup& setup);

}  // namespace stipple
