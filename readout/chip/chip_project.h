#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>

#include "readout/chip/chip_parameters.h"
#include "readout/chip/chip_settings.h"
#include "readout/stream_recorder.h"
#include "readout/timing/readout_cost.h"

namespace stipple {

/// Writes the folder from which a designer goes on (docs/rtl.md, "Start from your sensor"): the
/// chip in gates with the sizes of a sensor, its program and registers, a test bench, the DN that
/// the columns show, and the stream that the chip shall send.
class ChipProject {
  public:
    /// For a capture of `slots` slots into the folder, which exists. `setup` was cut (cut_array)
    /// and must outlive this. \throws InputError as chip_parameters, chip_settings and
    /// compile_schedule; DeviceError.
    ChipProject(const std::filesystem::path& folder, const SensorSetup& setup, int slots,
                const std::string& provenance);

    /// Exposes the next slot to `frame`. Precondition: fewer than `slots` were. \throws
    /// DeviceError.
    void expose(std::span<const float> frame);
    /// Writes the files that depend on all slots. \throws DeviceError.
    void finish();

    [[nodiscard]] const ChipParameters& chip() const { return chip_; }
    [[nodiscard]] const ChipCapture& capture() const { return capture_; }
    /// The files that lie in the folder after `finish`.
    [[nodiscard]] static bool is_own(std::string_view name);

  private:
    void write_parameters(std::uint32_t stream_crc) const;
    void write_registers() const;
    void write_view() const;
    void write_row(const SamplePacket& packet, int row);
    [[nodiscard]] std::string filled_in(std::string text, std::uint64_t header_bytes,
                                        std::uint64_t end_bytes) const;

    std::filesystem::path folder_;
    const SensorSetup& setup_;
    SequencerProgram program_;
    ChipParameters chip_;
    ChipCapture capture_;
    StreamRecorder recorder_;
    ReadoutCost cost_;
    std::ofstream dn_;
};

}  // namespace stipple
