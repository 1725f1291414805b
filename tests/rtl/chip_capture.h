#pragma once

#include <cstdint>
#include <vector>

#include "readout/chip/chip_settings.h"
#include "readout/program/sequencer_program.h"
#include "tests/rtl/chip_run.h"

namespace stipple {

/// Clocks in which the due tables of a bank are filled.
[[nodiscard]] std::int64_t fill_clocks(const ChipParameters& size, int rows, int period_slots);

/// Writes a register that is there. \throws InputError if the access is an error.
void set(ChipSimulation& chip, std::uint32_t address, std::uint32_t value);
/// The same, read.
[[nodiscard]] std::uint32_t get(ChipSimulation& chip, std::uint32_t address);

/// Sets the registers.
void set_up(ChipSimulation& chip, const ChipCapture& capture);
/// Writes a program of the size of the chip into a bank.
void load_bank(ChipSimulation& chip, const SequencerProgram& program, int bank);
/// Waits until the capture has ended. \throws InputError if it has not after `max_clocks`.
void wait_for_end(ChipSimulation& chip, std::int64_t max_clocks);

}  // namespace stipple
