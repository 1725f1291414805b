#pragma once

#include <cstdint>
#include <map>

#include "core/geometry.h"
#include "readout/column_addressing.h"
#include "readout/sensor_file.h"
#include "readout/timing/readout_cost.h"
#include "readout/timing/readout_timing.h"

namespace stipple {

/// What a chip is: its parameters as RTL (docs/rtl.md).
struct ChipGeometry {
    int rows = 0;  ///< of the array
    int cols = 0;
    ColumnAddressing addressing;
    int columns_per_adc = 1;
    int tile_rows = 1;  ///< of the schedule memory
    int tile_cols = 1;
    int pixel_bits = 1;
    int depth = 16;  ///< slots of a bank
    int bit_depth = 10;
    int dark_rows_max = 2;
};

/// The smallest chip of at least 16 slots a bank that runs `setup`. \throws InputError without a
/// timing, or as `compile_schedule`.
[[nodiscard]] ChipGeometry geometry_of(const SensorSetup& setup);

/// \throws InputError naming the limit if a program of `setup.schedule` does not fit, or the
/// memory has no size.
void check_geometry(const ChipGeometry& geometry);

/// Values of registers by address.
using RegisterValues = std::map<std::uint32_t, std::uint32_t>;

/// Those of region, policy and row timing that make a chip a sensor with this timing. `budget`: its
/// slots. \throws InputError if a list has more than 16 entries or a value more than its bits.
[[nodiscard]] RegisterValues register_values(const ReadoutTiming& timing, FrameShape window,
                                             SlotBudget budget);

/// What a chip runs.
struct ChipCapture {
    ReadoutTiming timing;
    FrameShape window;
    SlotBudget budget;
    int period_slots = 1;  ///< of the active bank
    int offset_slots = 0;
    int slots = 1;  ///< 0: until it is stopped
};

/// The registers that set up a capture from bank 0 or 1. \throws InputError as register_values.
[[nodiscard]] RegisterValues capture_registers(const ChipCapture& capture, int bank);

/// What these registers make a chip do in a capture.
struct CaptureSettings {
    ReadoutTiming timing;
    FrameShape window;
    SlotBudget slot;  ///< its length
    std::int64_t budget_clocks = 0;
    std::uint32_t slots = 0;  ///< 0: until STOP
};

/// \throws InputError naming the register and the limit that it breaks.
[[nodiscard]] CaptureSettings capture_settings(const RegisterValues& registers,
                                               const ChipGeometry& geometry);

}  // namespace stipple
