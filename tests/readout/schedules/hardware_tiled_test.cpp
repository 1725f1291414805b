#include "readout/schedules/hardware_tiled.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/support/fnv1a.h"
#include "tests/support/paper_schedule.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr std::uint64_t kSeeds[] = {1, 2, 3};

HardwareTile skip_channel(int channels, int array_cols) {
    return {.addressing = {.channels = channels}, .array_cols = array_cols};
}

HardwareTile in_groups(int rows, int cols, int channels = 1) {
    return {.addressing = {ColumnAddressing::Kind::kGroup, channels, cols, rows}};
}

/// In which slots of the period a pixel of the array is read, from its exposures.
std::vector<int> slots_read(const ExposureSchedule& schedule, int row, int col) {
    std::vector<int> slots;
    for (const Exposure& e :
         schedule.exposures(row % schedule.tile_rows(), col % schedule.tile_cols())) {
        int last = static_cast<int>(e.first_slot);
        for (std::uint64_t rest = e.open_slots; rest > 1; rest >>= 1U) ++last;
        slots.push_back(last % schedule.period_slots());
    }
    return slots;
}

/// Columns of an array row that are read in each slot by the channel with the most of them.
std::vector<int> busiest_channel(const ExposureSchedule& schedule, int row, int cols,
                                 int channels) {
    std::vector<int> busiest(static_cast<std::size_t>(schedule.period_slots()), 0);
    std::map<std::pair<int, int>, int> due;  // by slot and channel
    for (int col = 0; col < cols; ++col)
        for (const int slot : slots_read(schedule, row, col)) {
            int& most = busiest[static_cast<std::size_t>(slot)];
            most = std::max(most, ++due[{slot, col % channels}]);
        }
    return busiest;
}

/// The mean over rows and slots of the columns that the busiest channel reads.
double mean_load(const ExposureSchedule& schedule, int cols, int channels) {
    double sum = 0;
    for (int row = 0; row < schedule.tile_rows(); ++row) {
        const auto busiest = busiest_channel(schedule, row, cols, channels);
        sum += std::accumulate(busiest.begin(), busiest.end(), 0.0);
    }
    return sum / schedule.tile_rows() / schedule.period_slots();
}

/// The light that two pixels share, as in docs/hardware_schedules.md, slot by slot.
double shared_light(const ExposureSchedule& schedule, int row, int col, int other_row,
                    int other_col) {
    const auto marks = [&](int r, int c) {
        std::vector<std::vector<int>> open;
        for (const Exposure& e :
             schedule.exposures(r % schedule.tile_rows(), c % schedule.tile_cols())) {
            open.emplace_back(static_cast<std::size_t>(schedule.period_slots()), 0);
            for (unsigned i = 0; i < 64; ++i)
                if ((e.open_slots >> i & 1U) != 0)
                    open.back()[(e.first_slot + i) %
                                static_cast<unsigned>(schedule.period_slots())] = 1;
        }
        return open;
    };
    double sum = 0;
    for (const auto& a : marks(row, col))
        for (const auto& b : marks(other_row, other_col)) {
            const double shared = std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
            const double length_a = std::accumulate(a.begin(), a.end(), 0.0);
            const double length_b = std::accumulate(b.begin(), b.end(), 0.0);
            sum += shared * shared / (length_a * length_b);
        }
    return sum;
}

/// Mean light that a pixel shares with those to its right, below and on both diagonals.
double shared_with_neighbours(const ExposureSchedule& schedule) {
    constexpr int kSide = 60;
    double sum = 0;
    for (int row = 0; row < kSide; ++row)
        for (int col = 1; col <= kSide; ++col)
            sum += shared_light(schedule, row, col, row, col + 1) +
                   shared_light(schedule, row, col, row + 1, col) +
                   0.5 * shared_light(schedule, row, col, row + 1, col + 1) +
                   0.5 * shared_light(schedule, row, col, row + 1, col - 1);
    return sum / (3.0 * kSide * kSide);
}

std::string problem_of(const HardwareTile& tile, const std::vector<int>& lengths = {1, 2, 4, 8}) {
    return message_of<InputError>([&] { return hardware_tiled_schedule(tile, lengths, 1); });
}

TEST(HardwareTiledTest, EveryPixelRepeatsEveryLengthWithoutGaps) {
    for (const auto arrangement :
         {TileArrangement::kLattice, TileArrangement::kScatter, TileArrangement::kRandom}) {
        const auto schedule =
            hardware_tiled_schedule({.arrangement = arrangement}, kPaperExposureSlots, 1);
        EXPECT_TRUE(schedule.gapless());
        EXPECT_FALSE(schedule.interleaved());
        for (int row = 0; row < schedule.tile_rows(); ++row)
            for (int col = 0; col < schedule.tile_cols(); ++col) {
                std::vector<int> lengths;
                for (const Exposure& e : schedule.exposures(row, col))
                    lengths.push_back(e.light_slots());
                std::ranges::sort(lengths);
                ASSERT_EQ(lengths, (std::vector<int>{1, 2, 4, 8}));
            }
    }
}

// 15 pixels x 4 exposures = 15 slots x 4.
TEST(HardwareTiledTest, EveryRowOfATileReadsFourPixelsInEverySlot) {
    for (const auto arrangement : {TileArrangement::kLattice, TileArrangement::kScatter})
        for (const std::uint64_t seed : kSeeds) {
            const auto schedule =
                hardware_tiled_schedule({.arrangement = arrangement}, kPaperExposureSlots, seed);
            ASSERT_EQ(schedule.tile_cols(), 15);
            for (int row = 0; row < schedule.tile_rows(); ++row)
                ASSERT_EQ(busiest_channel(schedule, row, 15, 1), std::vector<int>(15, 4))
                    << "row " << row << " seed " << seed;
        }
}

// 1920 columns in 32 channels are 60 each, 4 whole tiles: 16 due in each channel, row and slot.
TEST(HardwareTiledTest, WholeTilesLoadEveryChannelAlike) {
    for (const auto arrangement : {TileArrangement::kLattice, TileArrangement::kScatter}) {
        HardwareTile tile = skip_channel(32, 1920);
        tile.arrangement = arrangement;
        const auto schedule = hardware_tiled_schedule(tile, kPaperExposureSlots, 1);
        for (int row = 0; row < schedule.tile_rows(); ++row)
            ASSERT_EQ(busiest_channel(schedule, row, 1920, 32), std::vector<int>(15, 16));
    }
}

// The busiest channel of a row reads at least ceil(mean) columns if slots are alike. The loads are
// the highest that were measured with these seeds.
TEST(HardwareTiledTest, ChannelsStayEvenWhereTheArrayEndsWithinATile) {
    struct Chip {
        int channels;
        int cols;
        double load;
    };
    for (const Chip chip : {Chip{16, 1280, 23},
                            {8, 1408, 48},
                            {4, 1280, 86.534},
                            {1, 1280, 341.334},
                            {16, 640, 12},
                            {7, 1001, 39.467},
                            {20, 2560, 36},
                            {10, 640, 19},
                            {3, 1000, 89.467},
                            {12, 1920, 44},
                            {16, 1279, 23}})
        for (const std::uint64_t seed : kSeeds) {
            const auto schedule = hardware_tiled_schedule(skip_channel(chip.channels, chip.cols),
                                                          kPaperExposureSlots, seed);
            EXPECT_LE(mean_load(schedule, chip.cols, chip.channels), chip.load)
                << chip.channels << " channels, " << chip.cols << " columns, seed " << seed;
        }
}

// 64 columns are 4 for each of 16 channels: 16 exposures in 15 slots, 20 times over the array. All
// channels can have the second one in the same slot, and then rows take the mean, 80 x 4 / 15.
TEST(HardwareTiledTest, ATileOfAnySizeIsAsEvenAsASearchFinds) {
    HardwareTile tile = skip_channel(16, 1280);
    tile.tile_rows = 64;
    tile.tile_cols = 64;
    const auto schedule = hardware_tiled_schedule(tile, kPaperExposureSlots, 1);
    EXPECT_EQ(schedule.tile_rows(), 64);
    EXPECT_EQ(schedule.tile_cols(), 64);
    EXPECT_NEAR(mean_load(schedule, 1280, 16), 80 * 4 / 15.0, 1e-9);
    const auto random = random_schedule(64, 1280, kPaperExposureSlots, 1);
    EXPECT_GE(mean_load(random, 1280, 16), 80 * 4 / 15.0 * 1.3);
}

// Channels of one or two pixels are only alike if a row has one or two codes; that costs quality.
TEST(HardwareTiledTest, NoRowIsInPhaseForTheSakeOfEvenChannels) {
    for (const int side : {16, 64}) {
        HardwareTile tile = skip_channel(32, 1920);
        tile.tile_rows = side;
        tile.tile_cols = side;
        const auto schedule = hardware_tiled_schedule(tile, kPaperExposureSlots, 1);
        for (int row = 0; row < side; ++row) {
            std::set<std::vector<int>> reads;
            for (int col = 0; col < side; ++col) {
                auto slots = slots_read(schedule, row, col);
                std::ranges::sort(slots);
                reads.insert(slots);
            }
            EXPECT_GE(reads.size(), side == 16 ? 12U : 40U) << "row " << row << " of " << side;
        }
    }
}

TEST(HardwareTiledTest, PixelsOfAGroupShareACodeAndRowsOfGroupsAreEven) {
    for (const auto arrangement : {TileArrangement::kLattice, TileArrangement::kScatter}) {
        HardwareTile tile = in_groups(2, 16, 16);
        tile.arrangement = arrangement;
        const auto schedule = hardware_tiled_schedule(tile, kPaperExposureSlots, 1);
        ASSERT_EQ(schedule.tile_cols(), 15 * 16);
        for (int row = 0; row < schedule.tile_rows(); ++row)
            for (int col = 0; col < schedule.tile_cols(); ++col)
                ASSERT_TRUE(std::ranges::equal(schedule.exposures(row, col),
                                               schedule.exposures(row / 2 * 2, col / 16 * 16)));
        for (int row = 0; row < schedule.tile_rows(); ++row)
            ASSERT_EQ(busiest_channel(schedule, row, 240, 16), std::vector<int>(15, 4));
    }
}

// Groups of 4 columns fill 4 of 16 channels: those channels must be even, too.
TEST(HardwareTiledTest, ChannelsAreEvenUnderSmallGroups) {
    HardwareTile tile = in_groups(1, 4, 16);
    tile.array_cols = 1280;
    for (const std::uint64_t seed : kSeeds) {
        const auto schedule = hardware_tiled_schedule(tile, kPaperExposureSlots, seed);
        EXPECT_LE(mean_load(schedule, 1280, 16), 22.534);  // mean 21.33
    }
}

TEST(HardwareTiledTest, NeighboursShareLessLightThanInTiledAndRandomTiles) {
    const auto shared = [](const ExposureSchedule& schedule) {
        return shared_with_neighbours(schedule);
    };
    const double tiled = shared(tiled_schedule(16, 16, kPaperExposureSlots, 1));
    const double random = shared(random_schedule(64, 64, kPaperExposureSlots, 1));
    for (const std::uint64_t seed : kSeeds) {
        HardwareTile tile;
        const double lattice = shared(hardware_tiled_schedule(tile, kPaperExposureSlots, seed));
        tile.arrangement = TileArrangement::kScatter;
        const double scatter = shared(hardware_tiled_schedule(tile, kPaperExposureSlots, seed));
        EXPECT_LT(lattice, 0.876 * std::min(tiled, random)) << "seed " << seed;
        EXPECT_LT(scatter, 0.882 * std::min(tiled, random)) << "seed " << seed;
    }
}

TEST(HardwareTiledTest, TheSameArgumentsGiveTheSameTile) {
    HardwareTile tile = skip_channel(16, 1280);
    for (const auto arrangement :
         {TileArrangement::kLattice, TileArrangement::kScatter, TileArrangement::kRandom}) {
        tile.arrangement = arrangement;
        const auto first = hardware_tiled_schedule(tile, kPaperExposureSlots, 1);
        EXPECT_EQ(first, hardware_tiled_schedule(tile, kPaperExposureSlots, 1));
    }
    EXPECT_NE(hardware_tiled_schedule(tile, kPaperExposureSlots, 1),
              hardware_tiled_schedule(tile, kPaperExposureSlots, 2));
}

// A recording: compilers, optimisation and processors must not change the annealing's decisions.
TEST(HardwareTiledTest, AScatteredTileHasTheRecordedBits) {
    HardwareTile tile = skip_channel(16, 1280);
    tile.tile_rows = 20;
    tile.tile_cols = 24;
    const auto schedule = hardware_tiled_schedule(tile, kPaperExposureSlots, 1);
    Fnv1a hash;
    for (int row = 0; row < 20; ++row)
        for (int col = 0; col < 24; ++col)
            for (const Exposure& e : schedule.exposures(row, col)) {
                hash.add(e.first_slot, 4);
                hash.add(e.open_slots, 8);
            }
    EXPECT_EQ(hash.hash(), 0x1d8fa4f4c7b8fde2U) << std::hex << hash.hash();
}

TEST(HardwareTiledTest, TakesOtherLengthsAndOddTiles) {
    for (const std::vector<int>& lengths : {std::vector<int>{1},
                                            {4},
                                            {1, 1},
                                            {1, 3},
                                            {1, 2, 4, 8, 16, 32},
                                            {64, 64, 64, 64},
                                            {3, 1, 4, 1, 5, 9, 2, 6}})
        for (const int side : {0, 1, 2, 7}) {
            HardwareTile tile = skip_channel(4, 50);
            tile.tile_rows = side;
            tile.tile_cols = side;
            const auto schedule = hardware_tiled_schedule(tile, lengths, 1);
            EXPECT_EQ(schedule.period_slots(), std::accumulate(lengths.begin(), lengths.end(), 0));
            EXPECT_TRUE(schedule.gapless());
            if (side > 0) {
                EXPECT_EQ(schedule.tile_rows(), side);
            }
        }
}

TEST(HardwareTiledTest, NamesTheKeyThatIsWrong) {
    expect_parts(problem_of({}, {}), {"exposure_slots", "give 1 to 16"});
    expect_parts(problem_of({}, {1, 65}), {"exposure_slots", "65"});
    expect_parts(problem_of({}, std::vector<int>(16, 64)), {"exposure_slots", "1024", "512"});
    expect_parts(problem_of({.addressing = {.channels = 0}}), {"channels", "0"});
    expect_parts(problem_of(in_groups(1, 0)), {"group_cols", "0"});
    expect_parts(problem_of(in_groups(-1, 1)), {"group_rows", "-1"});
    HardwareTile tile = in_groups(2, 16);
    tile.tile_cols = 40;
    expect_parts(problem_of(tile), {"tile_cols", "40", "group_cols 16"});
    tile.tile_cols = -1;
    expect_parts(problem_of(tile), {"tile_cols", "-1"});
    tile = {.tile_rows = 16384, .tile_cols = 16384};
    expect_parts(problem_of(tile), {"tile_rows", "16384"});
    tile = {.tile_rows = 64, .tile_cols = 64, .arrangement = TileArrangement::kLattice};
    expect_parts(problem_of(tile), {"lattice", "tile_rows", "15"});
    expect_parts(problem_of(in_groups(1, 60000)), {"900000", "groups"});
}

}  // namespace
}  // namespace stipple
