#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "readout/chip/chip_settings.h"
#include "readout/chip/running_capture.h"
#include "readout/chip/schedule_banks.h"
#include "readout/provenance.h"
#include "readout/sensor_file.h"

namespace stipple {

/// Where the captures of a chip come from and go to.
struct ChipFiles {
    std::filesystem::path output;  ///< of the first capture; the next one is NAME-2
    bool force = false;            ///< replace files that exist
    FootageOrigin footage = {};
    OpenLight open_light = {};
};

/// An emulated chip behind its registers (docs/chip_registers.md), with the clocks of the chip in
/// gates (docs/rtl.md): each access takes two. What it does in a capture is the emulated sensor's.
///
/// Not modelled: the rehearsal before slot 0 with DROPS; the time that packets take after the scan;
/// full queues.
class RegisterChip {
  public:
    /// After a reset. `setup` has a timing; its schedule is not loaded. `files.open_light` gives
    /// frames of the shape setup.footage. \throws InputError as check_geometry.
    RegisterChip(SensorSetup setup, const ChipGeometry& geometry, ChipFiles files);

    /// Sets the registers and bank 0 to those of `setup`. \throws InputError naming the limit that
    /// it breaks.
    void preset();

    /// The value of a register; nothing if the access is an error.
    [[nodiscard]] std::optional<std::uint32_t> read(std::uint32_t address);
    /// False if the access is an error. \throws InputError, DeviceError as a capture.
    bool write(std::uint32_t address, std::uint32_t value);
    /// Lets clocks pass. \throws as `write`.
    void wait(std::int64_t clocks);
    /// Ends a capture that runs, as STOP does. \throws as `write`.
    void finish();

    /// Since the reset.
    [[nodiscard]] std::int64_t clocks() const { return now_; }
    /// Why the last access or command was an error; then empty again.
    [[nodiscard]] std::string take_problem() { return std::exchange(problem_, {}); }
    /// Of the captures that have slots.
    [[nodiscard]] const std::vector<std::filesystem::path>& outputs() const { return outputs_; }

  private:
    void advance(std::int64_t clock);
    [[nodiscard]] std::uint32_t value_of(std::uint32_t address) const;
    [[nodiscard]] std::uint32_t status() const;
    [[nodiscard]] std::string read_problem(std::uint32_t address) const;
    [[nodiscard]] std::string write_problem(std::uint32_t address, std::uint32_t value) const;
    [[nodiscard]] bool is_locked(int bank) const;
    void store(std::uint32_t address, std::uint32_t value);
    void command(std::uint32_t bits, bool was_running);
    void start();
    void swap();
    [[nodiscard]] NamedSchedule schedule_of_bank(int bank, std::int64_t swap_slot) const;
    [[nodiscard]] std::int64_t fill_clocks(int bank) const;
    [[nodiscard]] CapturePlan plan() const;
    [[nodiscard]] std::string provenance(const CapturePlan& plan) const;
    void note(std::string_view why);
    void refuse(std::string_view why);

    SensorSetup setup_;
    ChipGeometry geometry_;
    ChipFiles files_;
    RegisterValues values_;
    ScheduleBanks banks_;
    int active_ = 0;
    std::uint32_t errors_ = 0;
    std::int64_t now_ = 0;
    std::unique_ptr<RunningCapture> capture_;
    ChipCounters counters_;  ///< of the last capture
    std::string problem_;
    std::vector<std::filesystem::path> outputs_;
};

}  // namespace stipple
