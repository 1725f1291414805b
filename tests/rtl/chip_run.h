#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "readout/chip/chip_parameters.h"

namespace stipple {

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

/// The DN of the columns of a row in a scan (counted from 0), from column 0 on.
using ColumnDn = std::function<std::vector<std::uint16_t>(int scan, int row)>;

/// What surrounds a chip.
struct ChipSurroundings {
    std::filesystem::path image;   ///< of bank 0; empty: none
    std::uint32_t stream_crc = 0;  ///< header CRC of the file
    ColumnDn dn;
    std::uint32_t seed = 1;  ///< of what the columns show outside conversions, and of tready
};

/// A chip that is being simulated: its registers, and what it has done since reset.
class ChipSimulation {
  public:
    virtual ~ChipSimulation() = default;
    /// A register (docs/chip_registers.md), in two clocks; nothing if the access is an error.
    virtual std::optional<std::uint32_t> read(std::uint32_t address) = 0;
    /// False if the access is an error.
    virtual bool write(std::uint32_t address, std::uint32_t value) = 0;
    virtual void wait(std::int64_t clocks) = 0;
    /// Header CRC of the file of the next capture.
    virtual void set_stream_crc(std::uint32_t crc) = 0;

    std::int64_t clocks = 0;       ///< since reset
    std::int64_t first_slot = -1;  ///< the clock of the first slot; events count from it
    ChipEvents events;
    std::vector<std::uint8_t> bytes;  ///< of the stream
    int packets = 0;
};

/// A verilated chip.
struct ChipModel {
    const char* name;
    ChipParameters size;
    std::unique_ptr<ChipSimulation> (*make)(const ChipParameters& size,
                                            const ChipSurroundings& with);
};

/// All verilated chips.
[[nodiscard]] std::span<const ChipModel> chip_models();

}  // namespace stipple
