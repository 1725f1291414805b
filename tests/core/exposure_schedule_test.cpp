#include "core/exposure_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/error.h"
#include "tests/readout/gapped_schedule.h"
#include "tests/support/fnv1a.h"
#include "tests/support/paper_schedule.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

/// Tile of 2 x 3 pixels, period 6: gapless, fluttering, interleaved and unused pixels.
ExposureSchedule mixed_schedule() {
    return {2,
            3,
            6,
            {0, 2, 3, 5, 6, 6, 8},
            {{0, 0b11},
             {2, 0b1111},
             {5, 0b101},
             {0, 0b10101},
             {1, 0b101},
             {3, 0b111111},
             {4, 0b1},
             {5, 0b11}}};
}

/// The tile pixel (row, col) of a one-pixel-wide schedule that breaks a rule.
std::string problem_of(int period_slots, std::vector<Exposure> exposures) {
    const auto count = static_cast<std::uint32_t>(exposures.size());
    return message_of<InputError>([&] {
        ExposureSchedule(1, 2, period_slots, {0, 0, count}, std::move(exposures));
    });
}

using Due = std::vector<std::pair<int, int>>;  // (column, span)

/// What the definition of a schedule says is read at the end of `slot`, exposure by exposure.
Due brute_force_due(const ExposureSchedule& schedule, int slot, int row, int cols) {
    Due due;
    for (int col = 0; col < cols; ++col)
        for (const Exposure& e :
             schedule.exposures(row % schedule.tile_rows(), col % schedule.tile_cols()))
            for (int begin = static_cast<int>(e.first_slot); begin <= slot;
                 begin += schedule.period_slots())
                if (begin + e.span_slots() - 1 == slot) due.emplace_back(col, e.span_slots());
    return due;
}

void expect_visits_match_brute_force(const ExposureSchedule& schedule, int rows, int cols) {
    for (int slot = 0; slot < 3 * schedule.period_slots(); ++slot) {
        std::size_t count = 0;
        for (int row = 0; row < rows; ++row) {
            Due visited;
            for_each_readout(schedule, slot, row, cols,
                             [&](int col, int span) { visited.emplace_back(col, span); });
            ASSERT_EQ(visited, brute_force_due(schedule, slot, row, cols))
                << "slot " << slot << " row " << row;
            count += visited.size();
        }
        EXPECT_EQ(count_due(schedule, slot, 0, rows, cols), count);
    }
}

TEST(ExposureScheduleTest, RandomScheduleCoversEachSlotOnceAtCompression15To4) {
    const auto schedule = random_schedule(16, 16, kPaperExposureSlots, 1);
    expect_paper_exposures(schedule);
    EXPECT_EQ(schedule.tile_rows(), 16);
    EXPECT_EQ(schedule.tile_cols(), 16);
    EXPECT_EQ(schedule.light_throughput(), 1.0);
}

TEST(ExposureScheduleTest, RandomPermutationsAndOffsetsAreEquallyFrequent) {
    // 24 permutations x 15 offsets, of which 4 each (the rotations) are the same schedule, make 90
    // equally likely ones: the slot of the shortest exposure and the order of the other three.
    const auto schedule = random_schedule(256, 256, kPaperExposureSlots, 7);
    std::map<std::vector<int>, int> count;
    for (int row = 0; row < 256; ++row)
        for (int col = 0; col < 256; ++col) {
            std::vector<int> spans;
            std::size_t shortest = 0;
            const auto exposures = schedule.exposures(row, col);
            for (const Exposure& e : exposures) {
                if (e.span_slots() == 1) shortest = spans.size();
                spans.push_back(e.span_slots());
            }
            std::rotate(spans.begin(), spans.begin() + static_cast<std::ptrdiff_t>(shortest),
                        spans.end());
            spans[0] = static_cast<int>(exposures[shortest].first_slot);
            ++count[spans];
        }
    ASSERT_EQ(count.size(), 90U);
    constexpr double kExpected = 65536.0 / 90;
    double chi_square = 0;
    for (const auto& [cell, n] : count) chi_square += (n - kExpected) * (n - kExpected) / kExpected;
    // Wilson-Hilferty: k (1 - 2/(9k) + z sqrt(2/(9k)))^3 with k = 89 degrees of freedom; z = 4.75
    // leaves a fair generator outside once in a million, on either side.
    EXPECT_LT(chi_square, 168);
    EXPECT_GT(chi_square, 40);
}

TEST(ExposureScheduleTest, RandomScheduleKeepsItsBits) {
    // The stream format promises these bits. Recomputed by an independent program from the
    // published algorithm of Philox4x32-10 and the text of random_schedule.
    const auto schedule = random_schedule(16, 16, kPaperExposureSlots, 1);
    Fnv1a hash;
    for (int row = 0; row < 16; ++row)
        for (int col = 0; col < 16; ++col)
            for (const Exposure& e : schedule.exposures(row, col)) {
                hash.add(e.first_slot, 4);
                hash.add(e.open_slots, 8);
            }
    EXPECT_EQ(hash.hash(), 0x7B85F3CB014C31FDU);
}

TEST(ExposureScheduleTest, RandomScheduleDependsOnTheSeed) {
    const auto one = random_schedule(8, 8, kPaperExposureSlots, 1);
    EXPECT_EQ(one, random_schedule(8, 8, kPaperExposureSlots, 1));
    EXPECT_FALSE(one == random_schedule(8, 8, kPaperExposureSlots, 2));
}

TEST(ExposureScheduleTest, RefusesAnExposureLengthThatDoesNotFitTheMask) {
    for (const int length : {0, -1, 65}) {
        const int lengths[] = {1, length};
        expect_parts(
            message_of<InputError>([&] { static_cast<void>(random_schedule(2, 2, lengths, 1)); }),
            {"exposure of " + std::to_string(length) + " slots", "1..64"});
    }
}

TEST(ExposureScheduleTest, VisitsWhatTheDefinitionSays) {
    expect_visits_match_brute_force(mixed_schedule(), 5, 8);
    expect_visits_match_brute_force(random_schedule(5, 7, kPaperExposureSlots, 3), 6, 16);
}

TEST(ExposureScheduleTest, ReadsNothingThatBeganBeforeTheFirstSlot) {
    // Open in slots 4, 5, 0, 1 of a period of 6: the first complete exposure ends in slot 7.
    const ExposureSchedule schedule(1, 1, 6, {0, 1}, {{4, 0b1111}});
    for (const int slot : {0, 1, 2, 6}) EXPECT_EQ(count_due(schedule, slot, 0, 1, 1), 0U);
    EXPECT_EQ(count_due(schedule, 7, 0, 1, 1), 1U);
    EXPECT_EQ(count_due(schedule, 13, 0, 1, 1), 1U);
}

TEST(ExposureScheduleTest, CountsLightAndSamplesOfGapsAndUnusedPixels) {
    const auto schedule = mixed_schedule();
    EXPECT_FALSE(schedule.gapless());
    EXPECT_TRUE(schedule.interleaved());
    EXPECT_DOUBLE_EQ(schedule.samples_per_pixel_slot(), 8.0 / 36);
    // Open slots: 2 + 4, 2, 3 + 2, 6, 0, 1 + 2 of 36.
    EXPECT_DOUBLE_EQ(schedule.light_throughput(), 22.0 / 36);
}

TEST(ExposureScheduleTest, TellsInterleavedFromFluttering) {
    EXPECT_FALSE(ExposureSchedule(1, 1, 6, {0, 2}, {{0, 0b101}, {3, 0b101}}).interleaved());
    EXPECT_TRUE(ExposureSchedule(1, 1, 6, {0, 2}, {{0, 0b101}, {1, 0b101}}).interleaved());
}

/// No two exposures of a pixel that are under way in the same slot may have one store.
void expect_stores_apart(const ExposureSchedule& schedule) {
    ASSERT_EQ(schedule.charge_stores(), 2);
    const auto period = static_cast<std::size_t>(schedule.period_slots());
    constexpr std::size_t kPeriods = 6;
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col) {
            std::vector<int> used[2] = {std::vector<int>(period * (kPeriods + 1)),
                                        std::vector<int>(period * (kPeriods + 1))};
            const auto exposures = schedule.exposures(row, col);
            for (std::size_t n = 0; n < kPeriods; ++n)
                for (std::size_t i = 0; i < exposures.size(); ++i) {
                    const int store = schedule.store(row, col, i, static_cast<std::int64_t>(n));
                    const std::size_t begin = n * period + exposures[i].first_slot;
                    for (int age = 0; age < exposures[i].span_slots(); ++age)
                        ASSERT_EQ(used[store][begin + static_cast<std::size_t>(age)]++, 0);
                }
        }
}

TEST(ExposureScheduleTest, GivesExposuresThatInterleaveStoresOfTheirOwn) {
    expect_stores_apart(alternating_schedule());
    for (const std::uint32_t seed : {1U, 2U, 3U})
        expect_stores_apart(interleaved_schedule(5, 7, 9, seed));
    expect_stores_apart(mixed_schedule());
}

TEST(ExposureScheduleTest, CountsTheChargeStoresThatAPixelNeeds) {
    EXPECT_EQ(ExposureSchedule(1, 1, 4, {0, 0}, {}).charge_stores(), 1);
    EXPECT_EQ(ExposureSchedule(1, 1, 4, {0, 2}, {{0, 0b11}, {2, 0b11}}).charge_stores(), 1);
    EXPECT_EQ(
        ExposureSchedule(1, 1, 9, {0, 3}, {{0, 0b1001}, {1, 0b1001}, {2, 0b1001}}).charge_stores(),
        3);
}

TEST(ExposureScheduleTest, NamesPixelAndSlotOfABrokenRule) {
    expect_parts(problem_of(4, {{4, 1}}), {"pixel (0, 1) slot 4", "beyond the period"});
    expect_parts(problem_of(4, {{2, 0b10}}), {"pixel (0, 1) slot 2", "closed in its first slot"});
    expect_parts(problem_of(4, {{1, 0}}), {"pixel (0, 1) slot 1", "closed in its first slot"});
    expect_parts(problem_of(4, {{1, 0b11111}}), {"pixel (0, 1) slot 1", "exceeds the period"});
    expect_parts(problem_of(4, {{0, 0b111}, {2, 0b1}}), {"pixel (0, 1) slot 2", "share"});
    expect_parts(problem_of(4, {{0, 0b1}, {3, 0b11}}), {"pixel (0, 1) slot 0", "share"});
}

TEST(ExposureScheduleTest, RefusesAnEmptyOrOversizedTileOrPeriod) {
    const auto tile = [](int rows, int cols) { return ExposureSchedule(rows, cols, 1, {0}, {}); };
    EXPECT_THROW(tile(0, 1), InputError);
    EXPECT_THROW(tile(1, 65536), InputError);
    EXPECT_THROW(static_cast<void>(random_schedule(2, 2, {}, 1)), InputError);
    EXPECT_THROW(ExposureSchedule(1, 1, 0, {0, 0}, {}), InputError);
    EXPECT_THROW(ExposureSchedule(1, 1, 65536, {0, 0}, {}), InputError);
}

TEST(ExposureScheduleTest, RefusesAListThatDoesNotMatchTheTile) {
    const std::vector<Exposure> two = {{0, 1}, {1, 1}};
    EXPECT_THROW(ExposureSchedule(1, 2, 4, {0, 2}, two), InputError);        // a pixel is missing
    EXPECT_THROW(ExposureSchedule(1, 2, 4, {0, 1, 1}, two), InputError);     // one is left over
    EXPECT_THROW(ExposureSchedule(1, 2, 4, {1, 1, 2}, two), InputError);     // one comes too early
    EXPECT_THROW(ExposureSchedule(1, 3, 4, {0, 2, 1, 2}, two), InputError);  // goes backwards
}

}  // namespace
}  // namespace stipple
