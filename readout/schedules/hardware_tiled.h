#pragma once

#include <cstdint>
#include <span>

#include "core/exposure_schedule.h"
#include "readout/timing/column_addressing.h"

namespace stipple {

/// How the codes of a tile made for the hardware lie (docs/hardware_schedules.md).
enum class TileArrangement : std::uint8_t {
    kAuto,     ///< kLattice where the size of the tile allows it, else kScatter
    kLattice,  ///< one cyclic order of the lengths; its first slot rises by row and by column
    kScatter,  ///< even rows and channels, then exchanges that set neighbours out of phase
    kRandom    ///< every group a code of its own by chance: what the others are compared with
};

/// What a tile is made for.
struct HardwareTile {
    ColumnAddressing addressing = {};
    int tile_rows = 0;   ///< pixels, whole groups; 0: what suits addressing and period
    int tile_cols = 0;   ///< the same
    int array_cols = 0;  ///< columns that are read, for which channels are balanced; 0: any number
    TileArrangement arrangement = TileArrangement::kAuto;

    bool operator==(const HardwareTile&) const = default;
};

/// Exposure lengths that a tile made for the hardware can have, and slots of them together.
inline constexpr int kMaxHardwareLengths = 16;
inline constexpr int kMaxHardwarePeriod = 512;
/// Exposures in such a tile, and pixels along its sides.
inline constexpr std::size_t kMaxHardwareExposures = std::size_t{1} << 22U;
inline constexpr int kLongestHardwareSide = 16384;

/// A tile in which every group of pixels (kSkipChannel: every pixel) repeats a permutation of
/// `exposure_slots` without gaps, such that in every slot and row about as many are due, in each
/// channel as well, and that neighbours have different light behind them: their exposures overlap
/// little. The same bits for the same arguments on any machine.
/// \throws InputError, naming the argument by its key in a schedule file, if there are no lengths
/// or more than kMaxHardwareLengths, one is outside 1..64, all are more than kMaxHardwarePeriod,
/// channels or a group is outside 1..65535, or a tile is not made of whole groups, too large, or
/// not of whole periods for kLattice.
[[nodiscard]] ExposureSchedule hardware_tiled_schedule(const HardwareTile& tile,
                                                       std::span<const int> exposure_slots,
                                                       std::uint64_t seed);

}  // namespace stipple
