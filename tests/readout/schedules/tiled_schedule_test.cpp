#include "readout/schedules/tiled_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <climits>
#include <numeric>
#include <set>
#include <vector>

#include "core/error.h"
#include "tests/support/paper_schedule.h"

namespace stipple {
namespace {

struct Counts {
    std::size_t fewest;
    std::size_t most;
};

/// Pixels of the tile that are due in the emptiest and in the fullest slot.
Counts due_per_slot(const ExposureSchedule& schedule) {
    std::vector<std::size_t> due;
    for (int slot = 0; slot < schedule.period_slots(); ++slot) {
        // One period later, when nothing is missing for want of light before slot 0.
        const int later = slot + schedule.period_slots();
        due.push_back(count_due(schedule, later, 0, schedule.tile_rows(), schedule.tile_cols()));
    }
    const auto [fewest, most] = std::ranges::minmax(due);
    return {fewest, most};
}

TEST(TiledScheduleTest, ReadsTheSameNumberInEverySlotButForOne) {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
        const auto counts = due_per_slot(tiled_schedule(16, 16, kPaperExposureSlots, seed));
        EXPECT_EQ(counts.fewest, 68U) << "seed " << seed;  // 256 x 4 = 15 x 68 + 4
        EXPECT_EQ(counts.most, 69U) << "seed " << seed;
    }
}

// Fifteen rotations of one pixel are even, so what can be done depends on the number of pixels
// modulo 15 alone, and every tile has an answer if those of 1 to 15 pixels have.
TEST(TiledScheduleTest, EvensOutTilesOfEverySize) {
    for (int cols = 1; cols <= 45; ++cols) {
        const auto counts = due_per_slot(tiled_schedule(1, cols, kPaperExposureSlots, 7));
        EXPECT_LE(counts.most - counts.fewest, 1U) << "1 x " << cols;
    }
    const auto large = due_per_slot(tiled_schedule(100, 90, kPaperExposureSlots, 7));
    EXPECT_EQ(large.most, large.fewest);  // 9000 = 15 x 600
}

TEST(TiledScheduleTest, EvensOutOtherExposures) {
    for (const std::vector<int>& lengths :
         {std::vector<int>{1}, {64}, {1, 64}, {2, 2, 2}, {3, 5}, {1, 2, 4, 8, 16, 32, 64}}) {
        const auto counts = due_per_slot(tiled_schedule(16, 16, lengths, 1));
        EXPECT_LE(counts.most - counts.fewest, 1U) << lengths.size() << " lengths";
    }
}

/// Pixels due per slot, added up over `pixels` of every kind there is: all totals.
std::set<std::vector<int>> all_due_counts(std::vector<int> lengths, int pixels) {
    const auto period = std::accumulate(lengths.begin(), lengths.end(), 0);
    std::set<std::vector<int>> totals = {std::vector<int>(static_cast<std::size_t>(period), 0)};
    std::ranges::sort(lengths);
    for (; pixels > 0; --pixels) {
        std::set<std::vector<int>> next;
        do {
            for (std::vector<int> total : totals)
                for (int offset = 0; offset < period; ++offset) {
                    std::vector<int> with = total;
                    int slot = offset;
                    for (const int length : lengths)
                        ++with[static_cast<std::size_t>((slot += length) % period)];
                    next.insert(with);
                }
        } while (std::ranges::next_permutation(lengths).found);
        totals = std::move(next);
    }
    return totals;
}

std::size_t min_spread(const std::set<std::vector<int>>& totals) {
    int least = INT_MAX;
    for (const auto& total : totals) {
        const auto [fewest, most] = std::ranges::minmax(total);
        least = std::min(least, most - fewest);
    }
    return static_cast<std::size_t>(least);
}

// Some tiles cannot be even. {2, 4}: a pixel is read in two even or in two odd slots, and three
// pixels have six samples for three even and three odd slots.
TEST(TiledScheduleTest, IsAsEvenAsAnySmallTileCanBe) {
    for (const std::vector<int>& lengths :
         {std::vector<int>{2, 4}, {2, 2, 4}, {1, 3}, {3, 3}, {1, 1, 4}, {1, 2, 4}})
        for (int pixels = 1; pixels <= 4; ++pixels) {
            const auto counts = due_per_slot(tiled_schedule(1, pixels, lengths, 1));
            EXPECT_EQ(counts.most - counts.fewest, min_spread(all_due_counts(lengths, pixels)))
                << pixels << " pixels, first of " << lengths.size() << " lengths " << lengths[0];
        }
}

TEST(TiledScheduleTest, GivesEveryPixelAllExposuresWithoutGaps) {
    const auto schedule = tiled_schedule(16, 16, kPaperExposureSlots, 1);
    EXPECT_EQ(schedule.tile_rows(), 16);
    EXPECT_EQ(schedule.tile_cols(), 16);
    expect_paper_exposures(schedule);
}

// There are 90 different pixels (24 permutations x 15 offsets / 4 rotations). Two chosen at random
// agree in 1 of 90 cases; of the 15 x 16 + 16 x 15 = 480 neighbouring pairs of a tile, 5.3 on
// average with a standard deviation of 2.3.
TEST(TiledScheduleTest, PutsNeighboursOutOfPhase) {
    const auto schedule = tiled_schedule(16, 16, kPaperExposureSlots, 1);
    const auto same = [&](int row, int col, int other_row, int other_col) {
        return std::ranges::equal(schedule.exposures(row, col),
                                  schedule.exposures(other_row, other_col));
    };
    int alike = 0;
    std::set<std::vector<std::uint64_t>> kinds;
    for (int row = 0; row < 16; ++row)
        for (int col = 0; col < 16; ++col) {
            if (col > 0 && same(row, col, row, col - 1)) ++alike;
            if (row > 0 && same(row, col, row - 1, col)) ++alike;
            std::vector<std::uint64_t> kind;
            for (const Exposure& e : schedule.exposures(row, col)) {
                kind.push_back(e.first_slot);
                kind.push_back(e.open_slots);
            }
            kinds.insert(kind);
        }
    EXPECT_LE(alike, 16);
    // 256 draws of 90 leave 90 (1 - 1/90)^256 = 5.2 out, with a standard deviation of 2.1.
    EXPECT_GE(kinds.size(), 75U);
}

TEST(TiledScheduleTest, DependsOnTheSeedAlone) {
    const auto one = tiled_schedule(16, 16, kPaperExposureSlots, 1);
    EXPECT_EQ(one, tiled_schedule(16, 16, kPaperExposureSlots, 1));
    EXPECT_FALSE(one == tiled_schedule(16, 16, kPaperExposureSlots, 2));
}

TEST(TiledScheduleTest, RefusesWhatNoTileCanBe) {
    const auto make = [](int rows, int cols, std::vector<int> lengths) {
        static_cast<void>(tiled_schedule(rows, cols, lengths, 1));
    };
    EXPECT_THROW(make(0, 16, {1}), InputError);
    EXPECT_THROW(make(16, 257, {1}), InputError);
    EXPECT_THROW(make(16, 16, {}), InputError);
    EXPECT_THROW(make(16, 16, {0}), InputError);
    EXPECT_THROW(make(16, 16, {65}), InputError);
    EXPECT_THROW(make(16, 16, std::vector<int>(256, 1)), InputError);
}

}  // namespace
}  // namespace stipple
