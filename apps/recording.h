#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

#include "apps/slot_emulator.h"
#include "io/pending_output.h"
#include "stream/stream_writer.h"

namespace stipple {

/// An emulated sensor whose samples go to a stream file.
class Recording {
  public:
    /// `setup` must outlive the recording. \throws InputError, DeviceError as PendingOutput and
    /// StreamWriter.
    Recording(const std::filesystem::path& file, bool force, const SensorSetup& setup,
              const FootageOrigin& footage);

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
    /// Part of the light since slot 0 that the samples hold, as SlotEmulator.
    [[nodiscard]] double light_read() const { return emulator_.light_read(); }
    /// Of the readout; null if the sensor has no timing.
    [[nodiscard]] ReadoutAccount* account() { return emulator_.account(); }
    [[nodiscard]] const ReadoutAccount* account() const { return emulator_.account(); }

  private:
    PendingOutput output_;
    SlotEmulator emulator_;
    StreamWriter writer_;
};

/// What was recorded, at which speed (nothing: not known), for programs: the keys of `emulate` in
/// docs/cli.md.
[[nodiscard]] nlohmann::ordered_json recording_json(const Recording& recording,
                                                    std::optional<double> slots_per_s);

/// The same in two lines for people.
[[nodiscard]] std::string recording_text(const Recording& recording,
                                         std::optional<double> slots_per_s);

}  // namespace stipple
