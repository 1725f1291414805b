#pragma once

#include <cstdint>
#include <span>

#include "core/exposure_schedule.h"
#include "readout/column_addressing.h"

namespace stipple {

/// Arrangement of the codes in a tile made for the hardware (docs/hardware_schedules.md).
enum class TileArrangement : std::uint8_t {
    kAuto,     ///< kLattice where the size of the tile allows it, else kScatter
    kLattice,  ///< one cyclic order of the lengths; its first slot rises by row and by column
    kScatter,  ///< balanced rows and channels, then exchanges of codes
    kRandom    ///< a random code for each group: the baseline
};

/// Parameters of a tile made for the hardware.
struct HardwareTile {
    ColumnAddressing addressing = {};
    int tile_rows = 0;   ///< pixels, whole groups; 0: chosen by addressing and period
    int tile_cols = 0;   ///< the same
    int array_cols = 0;  ///< columns of the array, for the balance of channels; 0: any number
    TileArrangement arrangement = TileArrangement::kAuto;

    bool operator==(const HardwareTile&) const = default;
};

/// Max number of exposure lengths of such a tile, and max sum of them in slots.
inline constexpr int kMaxHardwareLengths = 16;
inline constexpr int kMaxHardwarePeriod = 512;
/// Max exposures in such a tile, and max pixels along its sides.
inline constexpr std::size_t kMaxHardwareExposures = std::size_t{1} << 22U;
inline constexpr int kMaxHardwareSide = 16384;

/// A tile in which every group of pixels (kSkipChannel: every pixel) repeats a permutation of
/// `exposure_slots` without gaps. The number of due groups is balanced over slots, rows and
/// channels, and neighbours are out of phase. The same bits for the same arguments on any machine.
/// \throws InputError, naming the argument by its key in a schedule file, if there are no lengths
/// or more than kMaxHardwareLengths, one is outside 1..64, their sum exceeds kMaxHardwarePeriod,
/// channels are outside 1..4096 or a side of a group outside 1..65535, or a tile is too large or
/// does not have whole groups or, for kLattice, whole periods.
[[nodiscard]] ExposureSchedule hardware_tiled_schedule(const HardwareTile& tile,
                                                       std::span<const int> exposure_slots,
                                                       std::uint64_t seed);

}  // namespace stipple
