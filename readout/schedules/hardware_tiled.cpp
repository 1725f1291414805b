#include "readout/schedules/hardware_tiled.h"

#include <fmt/format.h>

#include <numeric>
#include <string>

#include "core/error.h"
#include "readout/schedules/hardware_tiled_parts.h"

namespace stipple {
namespace {

constexpr int kFewGroups = 12;  ///< min side of a scattered tile

void fail(const std::string& problem) {
    throw InputError("hardware_tiled", problem);
}

void check_lengths(std::span<const int> lengths) {
    if (lengths.empty() || lengths.size() > kMaxHardwareLengths)
        fail(fmt::format("exposure_slots holds {} lengths; give 1 to {}", lengths.size(),
                         kMaxHardwareLengths));
    for (const int length : lengths)
        if (length < 1 || length > kMaxExposureSlots)
            fail(fmt::format("exposure_slots: {} slots are outside 1..{}", length,
                             kMaxExposureSlots));
    const int period = std::accumulate(lengths.begin(), lengths.end(), 0);
    if (period > kMaxHardwarePeriod)
        fail(fmt::format("exposure_slots are {} slots together; at most {} are designed for",
                         period, kMaxHardwarePeriod));
}

/// Groups along a side of `pixels`, 0 if it is to be chosen.
int whole_groups(const char* key, int pixels, int group, const char* group_key) {
    if (pixels < 0 || pixels > kMaxHardwareSide)
        fail(fmt::format("{} {} is outside 0..{}", key, pixels, kMaxHardwareSide));
    if (pixels % group != 0)
        fail(fmt::format("{} {} is not a multiple of {} {}", key, pixels, group_key, group));
    return pixels / group;
}

/// The least columns, in groups, of which every class of channels gets whole periods; where that
/// is too wide, whole periods.
int even_cols(int period, int classes) {
    const int min_periods = (kFewGroups + period - 1) / period;
    for (int periods = min_periods; periods * period <= 256; ++periods)
        if (periods % std::gcd(periods * period, classes) == 0) return periods * period;
    return min_periods * period;
}

void check_size(const GroupGrid& grid, int rows, int cols, std::size_t lengths) {
    const std::int64_t pixel_rows = std::int64_t{rows} * grid.group_rows;
    const std::int64_t pixel_cols = std::int64_t{cols} * grid.group_cols;
    const std::int64_t exposures = pixel_rows * pixel_cols * static_cast<std::int64_t>(lengths);
    if (pixel_rows > kMaxHardwareSide || pixel_cols > kMaxHardwareSide ||
        exposures > static_cast<std::int64_t>(kMaxHardwareExposures))
        fail(fmt::format(
            "a tile of {} x {} pixels (tile_rows x tile_cols) with {} exposures; at "
            "most {} along a side and {} exposures can be designed: make groups or "
            "the tile smaller",
            pixel_rows, pixel_cols, exposures, kMaxHardwareSide, kMaxHardwareExposures));
}

/// The sizes are in groups, 0: to be chosen.
GroupTile design(const HardwareTile& wanted, const GroupGrid& grid, const CodeSet& codes,
                 Draws& draws) {
    int rows = whole_groups("tile_rows", wanted.tile_rows, grid.group_rows, "group_rows");
    int cols = whole_groups("tile_cols", wanted.tile_cols, grid.group_cols, "group_cols");
    const int period = codes.period();
    check_size(grid, rows == 0 ? period : rows, cols == 0 ? period : cols, codes.lengths());
    const bool lattice = wanted.arrangement == TileArrangement::kAuto ||
                         wanted.arrangement == TileArrangement::kLattice;
    if (lattice)
        if (auto tile = lattice_tile(grid, codes, rows, cols, draws)) {
            check_size(grid, tile->rows, tile->cols, codes.lengths());
            return *std::move(tile);
        }
    if (wanted.arrangement == TileArrangement::kLattice)
        fail(
            fmt::format("arrangement \"lattice\": tile_rows and tile_cols must be multiples of "
                        "the period, {} groups",
                        period));
    if (cols == 0) cols = even_cols(period, grid.channel_classes);
    if (rows == 0) rows = cols;
    check_size(grid, rows, cols, codes.lengths());
    return wanted.arrangement == TileArrangement::kRandom
               ? random_tile(codes, rows, cols, draws)
               : scatter_tile(grid, codes, rows, cols, draws);
}

ExposureSchedule schedule_of(const GroupTile& tile, const GroupGrid& grid, const CodeSet& codes) {
    const int rows = tile.rows * grid.group_rows;
    const int cols = tile.cols * grid.group_cols;
    std::vector<std::uint32_t> first{0};
    std::vector<Exposure> exposures;
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            codes.append(tile.at(row / grid.group_rows, col / grid.group_cols), exposures);
            first.push_back(static_cast<std::uint32_t>(exposures.size()));
        }
    return {rows, cols, codes.period(), std::move(first), std::move(exposures)};
}

}  // namespace

ExposureSchedule hardware_tiled_schedule(const HardwareTile& tile,
                                         std::span<const int> exposure_slots, std::uint64_t seed) {
    check_lengths(exposure_slots);
    const GroupGrid grid = grid_of(tile);
    Draws draws(seed, DrawPlane::kHardwareTiled);
    const CodeSet codes(exposure_slots, draws);
    return schedule_of(design(tile, grid, codes, draws), grid, codes);
}

}  // namespace stipple
