#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "io/pending_output.h"
#include "readout/emulator.h"
#include "stream/stream_writer.h"

namespace stipple {

struct StreamRecorderOptions {
    bool force = false;           ///< replace the file if it exists
    bool may_switch = false;      ///< the stream may change its schedule (version 4)
    std::string provenance = {};  ///< text of the header, as `provenance_of` writes it; empty: none
};

/// An emulated sensor that writes its samples to a stream file. The file gets its final name in
/// `finish` or `keep`. If the schedule of a sensor with timing may change, a slot is written when
/// the next one begins, as a switch may lengthen it.
class StreamRecorder {
  public:
    /// `setup` must outlive the recorder. \throws InputError, DeviceError as PendingOutput and
    /// StreamWriter.
    StreamRecorder(const std::filesystem::path& file, const SensorSetup& setup,
                   StreamRecorderOptions options = {});
    ~StreamRecorder();

    /// As Emulator::switch_to, in the stream, too. Precondition: options.may_switch, and a slot was
    /// exposed. Returns what the stream says of it. \throws InputError as Emulator::switch_to and
    /// StreamWriter::switch_schedule: then it goes on as before. DeviceError.
    ScheduleSwitch switch_to(const SensorSetup& next);

    /// Exposes the next slot to `frame` (of the footage's shape, order (plane, row, col)) and
    /// writes its samples, without those of dropped rows.
    /// Returns the packets written, valid until the next call. \throws DeviceError.
    std::span<const SamplePacket> expose(std::span<const float> frame);
    /// The same as Emulator::expose with the cost of a slot.
    std::span<const SamplePacket> expose(std::span<const float> frame, const SlotCost& slot);
    /// The same for a slot whose samples are all dropped, which takes a fraction of the time.
    std::span<const SamplePacket> expose_unread(std::span<const float> frame);
    /// Puts the file in place. \throws DeviceError.
    void finish();

    /// After a write error: keeps the stream up to that point. False and no effect if the error was
    /// in giving the file its name. \throws DeviceError.
    bool keep();

    /// The sensor, for its figures.
    [[nodiscard]] const Emulator& emulator() const { return *emulator_; }
    /// Samples in the stream.
    [[nodiscard]] std::uint64_t samples() const { return samples_; }
    [[nodiscard]] std::uint64_t payload_bits() const;
    /// Counted values of light per counted sample. Infinite before the first sample.
    [[nodiscard]] double compression_ratio() const;
    /// Fraction of the samples that the full well has clipped or that are at full scale, those of
    /// dropped rows too. NaN before the first sample.
    [[nodiscard]] double saturated_fraction() const;
    /// The same of the samples that are DN 0.
    [[nodiscard]] double zero_fraction() const;

  private:
    std::span<const SamplePacket> written(std::span<const SamplePacket> packets);
    void write_waiting();

    PendingOutput output_;
    std::unique_ptr<Emulator> emulator_;
    StreamWriter writer_;
    bool holds_back_;
    std::optional<SamplePacket> waiting_;  ///< the last slot
    std::uint64_t samples_ = 0;
};

}  // namespace stipple
