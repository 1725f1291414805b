#include "readout/schedules/random_codes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace stipple {
namespace {

constexpr std::uint64_t kSeed = 3;

std::vector<int> lengths_of(std::span<const Exposure> exposures) {
    std::vector<int> lengths;
    for (const Exposure& e : exposures) {
        EXPECT_EQ(e.span_slots(), e.light_slots());
        lengths.push_back(e.span_slots());
    }
    std::ranges::sort(lengths);
    return lengths;
}

TEST(ScatteredScheduleTest, GivesEveryPixelItsLengths) {
    const int lengths[] = {1, 2, 4, 8};
    const auto schedule = scattered_schedule({8, 8, 20, true}, lengths, kSeed);
    EXPECT_EQ(schedule.period_slots(), 20);
    EXPECT_EQ(schedule.charge_stores(), 1);
    for (int row = 0; row < 8; ++row)
        for (int col = 0; col < 8; ++col)
            EXPECT_EQ(lengths_of(schedule.exposures(row, col)), (std::vector<int>{1, 2, 4, 8}));
}

/// How many of 4096 pixels begin their only exposure, of 3 slots in 8, in each slot.
std::vector<int> begin_counts(bool wrap) {
    const int length[] = {3};
    const auto schedule = scattered_schedule({64, 64, 8, wrap}, length, kSeed);
    std::vector<int> count(8, 0);
    for (int row = 0; row < 64; ++row)
        for (int col = 0; col < 64; ++col) ++count[schedule.exposures(row, col)[0].first_slot];
    return count;
}

// Binomial counts: 4096 draws of probability p have the standard deviation sqrt(4096 p (1 - p));
// five of them are passed once in two million times.
TEST(ScatteredScheduleTest, TakesAllPlacesEquallyOften) {
    for (const int n : begin_counts(true))
        EXPECT_NEAR(n, 4096 / 8.0, 5 * std::sqrt(4096 / 8.0 * 7 / 8));
    const std::vector<int> within = begin_counts(false);
    for (std::size_t slot = 0; slot < 8; ++slot)
        if (slot < 6)
            EXPECT_NEAR(within[slot], 4096 / 6.0, 5 * std::sqrt(4096 / 6.0 * 5 / 6)) << slot;
        else
            EXPECT_EQ(within[slot], 0) << "goes beyond the period";
}

TEST(ScatteredScheduleTest, RefusesMoreThanThePeriodHolds) {
    const int nine[] = {4, 5};
    const int none[] = {0};
    const int long_one[] = {65};
    EXPECT_THROW(static_cast<void>(scattered_schedule({1, 1, 8, true}, nine, kSeed)), InputError);
    EXPECT_THROW(static_cast<void>(scattered_schedule({1, 1, 8, true}, none, kSeed)), InputError);
    EXPECT_THROW(static_cast<void>(scattered_schedule({1, 1, 8, true}, {}, kSeed)), InputError);
    EXPECT_THROW(static_cast<void>(scattered_schedule({1, 1, 99, true}, long_one, kSeed)),
                 InputError);
    EXPECT_EQ(scattered_schedule({1, 1, 9, true}, nine, kSeed).light_throughput(), 1);
}

TEST(FlutterScheduleTest, OpensAsManySlotsOfEachCodeAsAreAskedFor) {
    const auto schedule = flutter_schedule({4, 4, 12, 5, 3, false}, kSeed);
    EXPECT_EQ(schedule.period_slots(), 36);
    for (int row = 0; row < 4; ++row)
        for (int col = 0; col < 4; ++col) {
            ASSERT_EQ(schedule.exposures(row, col).size(), 3U);
            for (std::size_t code = 0; code < 3; ++code) {
                const Exposure& e = schedule.exposures(row, col)[code];
                EXPECT_EQ(e.light_slots(), 5);
                EXPECT_EQ(e.first_slot / 12, code);
                EXPECT_EQ((e.first_slot + static_cast<std::uint32_t>(e.span_slots()) - 1) / 12,
                          code);
            }
        }
}

TEST(FlutterScheduleTest, OpensEverySlotEquallyOften) {
    std::vector<int> open(8, 0);
    const auto schedule = flutter_schedule({64, 64, 8, 3, 1, false}, kSeed);
    for (int row = 0; row < 64; ++row)
        for (int col = 0; col < 64; ++col) {
            const Exposure& e = schedule.exposures(row, col)[0];
            for (std::size_t slot = e.first_slot; slot < 8; ++slot)
                open[slot] += static_cast<int>(e.open_slots >> (slot - e.first_slot) & 1U);
        }
    for (const int n : open) EXPECT_NEAR(n, 4096 * 3 / 8.0, 5 * std::sqrt(4096 * 3 / 8.0 * 5 / 8));
}

TEST(FlutterScheduleTest, LosesNoLightWithAComplement) {
    const auto schedule = flutter_schedule({8, 8, 8, 4, 2, true}, kSeed);
    EXPECT_EQ(schedule.light_throughput(), 1);
    EXPECT_EQ(schedule.samples_per_pixel_slot(), 2.0 / 8);
    EXPECT_EQ(schedule.charge_stores(), 2);
}

TEST(FlutterScheduleTest, RefusesCodesThatHaveNoSuchSlots) {
    for (const Flutter& wrong : {Flutter{1, 1, 65, 1, 1, false}, Flutter{1, 1, 8, 0, 1, false},
                                 Flutter{1, 1, 8, 9, 1, false}, Flutter{1, 1, 8, 8, 1, true},
                                 Flutter{1, 1, 8, 4, 8192, false}, Flutter{0, 1, 8, 4, 1, false}})
        EXPECT_THROW(static_cast<void>(flutter_schedule(wrong, kSeed)), InputError);
}

}  // namespace
}  // namespace stipple
