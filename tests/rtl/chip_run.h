#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "readout/timing/readout_cost.h"

namespace stipple {

/// Parameters of a verilated chip (rtl/stipple_chip.sv).
struct ChipSize {
    int rows = 0;
    int cols = 0;
    int channels = 1;
    int columns_per_adc = 1;
    int group_rows = 1;
    int group_cols = 1;
    int tile_rows = 1;
    int tile_cols = 1;
    int pixel_bits = 1;
    int depth = 1;  ///< slots of the schedule memory
    int bit_depth = 8;
    int dark_rows = 0;  ///< max
    int word_bytes = 4;
};

/// What a chip runs.
struct ChipProgram {
    ReadoutTiming timing;
    FrameShape window;
    SlotBudget budget;
    int period_slots = 1;
    std::uint32_t stream_crc = 0;  ///< header CRC of the file
    std::filesystem::path image;   ///< of the schedule memory
    int packets = 1;               ///< after which, and min_clocks, the run ends
    std::int64_t min_clocks = 0;
    std::int64_t max_clocks = 1;
    std::uint32_t seed = 1;  ///< of what the columns show outside conversions, and of tready
};

/// A strobe of the chip, `place` is its row (dark rows below 0) or 0.
struct ChipEvent {
    std::int64_t clock = 0;  ///< since the first slot
    int row = 0;

    auto operator<=>(const ChipEvent&) const = default;
};

/// The strobes of a run, each in the order of time.
struct ChipEvents {
    std::vector<ChipEvent> slot_start, scan_start, select, convert, convert_end, transfer,
        transfer_end, row_done;
};

struct ChipRun {
    ChipEvents events;
    std::vector<std::uint8_t> bytes;  ///< of the stream
    int packets = 0;
    unsigned fault = 0;
    std::int64_t clocks = 0;
};

/// The DN of the columns of a row in a scan (counted from 0), from column 0 on.
using ColumnDn = std::function<std::vector<std::uint16_t>(int scan, int row)>;

/// A verilated chip.
struct ChipModel {
    const char* name;
    ChipSize size;
    ChipRun (*run)(const ChipSize& size, const ChipProgram& program, const ColumnDn& dn);
};

/// All verilated chips.
[[nodiscard]] std::span<const ChipModel> chip_models();

}  // namespace stipple
