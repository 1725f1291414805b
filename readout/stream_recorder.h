#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "io/pending_output.h"
#include "readout/emulator.h"
#include "stream/stream_writer.h"

namespace stipple {

/// An emulated sensor whose samples go to a stream file: light in, packets out. The file appears
/// under its name when `finish` or `keep` has put it there.
class StreamRecorder {
  public:
    /// `setup` must outlive the recorder; `provenance` as in stream_header_of. \throws InputError,
    /// DeviceError as PendingOutput and StreamWriter.
    StreamRecorder(const std::filesystem::path& file, bool force, const SensorSetup& setup,
                   std::string provenance);

    /// Exposes the next slot to `frame` (of the footage's shape, order (plane, row, col)) and
    /// writes its samples: those that the readout has time for, if rows are dropped.
    /// Returns what was written, valid until the next call. \throws DeviceError.
    std::span<const SamplePacket> expose(std::span<const float> frame);
    /// Puts the file in place. \throws DeviceError.
    void finish();

    /// The same where writing has failed: a stream as far as it goes. False, with nothing done, if
    /// it was putting it in place that failed. \throws DeviceError.
    bool keep();

    [[nodiscard]] const SensorSetup& setup() const { return emulator_.setup(); }
    [[nodiscard]] const ReadoutStats& stats() const { return emulator_.stats(); }
    /// Samples in the stream.
    [[nodiscard]] std::uint64_t samples() const;
    [[nodiscard]] std::uint64_t payload_bits() const;
    /// Light values per sample, both counted. Infinite before the first sample.
    [[nodiscard]] double compression_ratio() const;
    /// Share of the samples that the full well has clipped or that are at full scale, dropped ones
    /// too. NaN before the first sample.
    [[nodiscard]] double saturated_fraction() const;
    /// Part of the light that is collected once the first exposures are over.
    [[nodiscard]] double light_throughput() const;
    /// Part of the light since slot 0 that the samples hold, as Emulator.
    [[nodiscard]] double light_read() const { return emulator_.light_read(); }
    /// Of the readout; null if the sensor has no timing.
    [[nodiscard]] ReadoutAccount* account() { return emulator_.account(); }
    [[nodiscard]] const ReadoutAccount* account() const { return emulator_.account(); }

  private:
    PendingOutput output_;
    Emulator emulator_;
    StreamWriter writer_;
};

}  // namespace stipple
