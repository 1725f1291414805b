#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "readout/timing/readout_cost.h"
#include "readout/timing/readout_timing.h"

namespace stipple {

/// What a chip runs.
struct ChipCapture {
    ReadoutTiming timing;
    FrameShape window;
    SlotBudget budget;
    int period_slots = 1;  ///< of the active bank
    int offset_slots = 0;
    int slots = 1;  ///< 0: until it is stopped
};

/// A value of a register (docs/chip_registers.md).
struct RegisterValue {
    std::uint32_t address = 0;
    std::uint32_t value = 0;
};

/// The values of the registers that set up a capture from bank 0 or 1. \throws InputError naming
/// the register of a value that it cannot hold.
[[nodiscard]] std::vector<RegisterValue> chip_settings(const ChipCapture& capture, int bank);

/// The name of a register, with its place if there are several: "SETTLE_CLOCKS[3]". Empty if there
/// is none at this address.
[[nodiscard]] std::string register_name(std::uint32_t address);

}  // namespace stipple
