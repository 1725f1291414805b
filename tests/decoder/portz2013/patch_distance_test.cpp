#include "decoder/portz2013/patch_distance.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/decoder/hand_made.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

constexpr FrameShape kTwoPixels{.rows = 1, .cols = 2, .planes = 1};

/// Figure 2 of the paper: a patch of slots 2 to 5; y1 covers it, of the other pixel's samples y2
/// and y4 lie in it by half and y3 wholly.
ExposureTable figure_2(const HandSample& y1, float y2, const HandSample& y3, float y4) {
    return ExposureTable(hand_made(8, kTwoPixels, {y1, {1, 1, 0b11, y2}, y3, {1, 5, 0b11, y4}}));
}

SampleDifference compare(const ExposureTable& table) {
    return compare_samples(table, {0, 2}, {1, 2}, 4);
}

TEST(PatchDistanceTest, BlursTheShorterSamplesAsInFigure2) {
    // z = y2 / 2 + y3 + y4 / 2 = 3.5, its variance 1/4 + 1 + 1/4, the weight 4 / (1 + 1.5).
    const ExposureTable table = figure_2({0, 2, 0b1111, 5}, 1, {1, 3, 0b11, 2}, 2);
    const SampleDifference d = compare(table);
    EXPECT_FLOAT_EQ(d.weight, 1.6F);
    EXPECT_FLOAT_EQ(d.error, 1.6F * (5 - 3.5F) * (5 - 3.5F));
    EXPECT_EQ(d.cover, 4);
    const SampleDifference other_way = compare_samples(table, {1, 2}, {0, 2}, 4);
    EXPECT_EQ(other_way.error, d.error);
    EXPECT_EQ(other_way.weight, d.weight);
}

TEST(PatchDistanceTest, ShiftsTheOtherPatchInTime) {
    const ExposureTable table(hand_made(
        12, kTwoPixels, {{0, 2, 0b1111, 5}, {1, 5, 0b11, 1}, {1, 7, 0b11, 2}, {1, 9, 0b11, 2}}));
    const SampleDifference d = compare_samples(table, {0, 2}, {1, 6}, 4);
    EXPECT_FLOAT_EQ(d.error, 1.6F * 1.5F * 1.5F);
}

TEST(PatchDistanceTest, ASaturatedSampleIsABound) {
    // z = 3.5 in all cases.
    const auto error = [](float y1, bool target, bool source) {
        const SampleDifference d =
            compare(figure_2({0, 2, 0b1111, y1, target}, 1, {1, 3, 0b11, 2, source}, 2));
        EXPECT_FLOAT_EQ(d.weight, target && source ? 0 : 1.6F);
        return d.error;
    };
    EXPECT_EQ(error(3, true, false), 0) << "3 or more, and z is more";
    EXPECT_FLOAT_EQ(error(4, true, false), 1.6F * 0.25F) << "4 or more, but z is less";
    EXPECT_EQ(error(4, false, true), 0) << "z is 3.5 or more";
    EXPECT_FLOAT_EQ(error(3, false, true), 1.6F * 0.25F) << "z is 3.5 or more, the target less";
    EXPECT_EQ(error(9, true, true), 0) << "not compared at all";
}

TEST(PatchDistanceTest, OfEqualSamplesTheOneThatCoversMoreIsTheTarget) {
    // Patch of slots 0 to 3. Both samples are 4 slots long; the second pixel's covers 3 of the
    // patch, the first one's 2, and only with that as the target is z unknown.
    const ExposureTable table(
        hand_made(6, kTwoPixels, {{0, 2, 0b1111, 1}, {1, 1, 0b1111, 1}, {0, 0, 0b11, 1}}));
    const SampleDifference d = compare_samples(table, {0, 0}, {1, 0}, 4);
    // z = 1 / 2 y + 3 / 4 y = 1.25, variance 1/4 + 9/16 = 13/16.
    EXPECT_EQ(d.cover, 3);
    EXPECT_FLOAT_EQ(d.weight, 3 / (1 + 13 / 16.F));
    EXPECT_FLOAT_EQ(d.error, 3 / (1 + 13 / 16.F) * 0.0625F);
}

TEST(PatchDistanceTest, ALongerSampleCountsByItsShareOfATarget) {
    // Patch of slots 2 and 3, y = 1 of both; the other pixel has 0.25 of slot 2, and 8 of slots 3
    // to 10, for which as a target too little is known.
    const ExposureTable table(
        hand_made(12, kTwoPixels, {{0, 2, 0b11, 1}, {1, 2, 1, 0.25F}, {1, 3, 0b11111111, 8}}));
    const SampleDifference d = compare_samples(table, {0, 2}, {1, 2}, 2);
    const float weight = 2 / (1 + 1 + 1 / 64.F);
    EXPECT_EQ(d.cover, 2);
    EXPECT_FLOAT_EQ(d.weight, weight);
    EXPECT_FLOAT_EQ(d.error, weight * (1 - 1.25F) * (1 - 1.25F));
}

TEST(PatchDistanceTest, NeedsAnEighthOfThePatch) {
    const auto distance = [](std::uint64_t open_slots) {
        const ExposureTable table(
            hand_made(20, kTwoPixels, {{0, 0, open_slots, 1}, {1, 0, open_slots, 1}}));
        return patch_distance(table, {1, 1, 16}, {0, 0, 0}, {0, 0, 1}, 1e9F);
    };
    EXPECT_EQ(distance(0b1), std::numeric_limits<float>::infinity());
    EXPECT_EQ(distance(0b11), 0);
}

TEST(PatchDistanceTest, ComparesNothingWhereSamplesAreMissing) {
    const ExposureTable table(hand_made(8, kTwoPixels, {{0, 2, 0b1111, 5}, {1, 1, 0b11, 1}}));
    EXPECT_EQ(compare(table).weight, 0);
    EXPECT_EQ(patch_distance(table, {1, 1, 4}, {2, 0, 0}, {2, 0, 1}, 1e9F),
              std::numeric_limits<float>::infinity());
}

TEST(PatchDistanceTest, OfTheSameLightIsTheNoise) {
    // A scene at rest and everywhere the same, light 0.2, the paper's sensor: the variance of a
    // sample is (200 + 100) / 1e6 for 1 slot to (1600 + 100) / 1e6 for 8. A residual has 1 + the
    // variance of z times that, 1 + 3 at most: y of 2^n slots against n + 1 samples or fewer.
    FluxVideo video(32, {24, 24, 1});
    std::ranges::fill(video.data(), 0.2F);
    const ExposureTable table(measure(video, random_schedule(24, 24, kPaperExposureSlots, 3)));
    double sum = 0;
    int count = 0;
    for (int row = 0; row < 18; row += 3)
        for (int col = 0; col + 12 <= 24; col += 3, ++count)
            sum += static_cast<double>(
                patch_distance(table, {6, 6, 4}, {12, row, col}, {14, 18 - row, col + 6}, 1));
    EXPECT_GT(sum / count, 0.0003);
    EXPECT_LT(sum / count, 4 * 0.0017);
}

TEST(PatchDistanceTest, GivesUpOnlyWhereTheBoundIsExceeded) {
    FluxVideo video = random_video(24, {16, 16, 3}, 5);
    for (float& light : video.data()) light *= 0.2F;
    const ExposureTable table(measure(video, random_schedule(16, 16, kPaperExposureSlots, 2)));
    int given_up = 0;
    for (int col = 1; col < 10; ++col) {
        const PatchPosition at{10, 4, col};
        const float exact = patch_distance(table, {6, 6, 4}, {8, 2, 0}, at, 1e9F);
        for (const float share : {0.01F, 0.05F, 0.5F, 0.99F, 1.01F}) {
            const float d = patch_distance(table, {6, 6, 4}, {8, 2, 0}, at, exact * share);
            EXPECT_TRUE(d == exact || (d > exact && share < 1)) << share;
            given_up += d == exact ? 0 : 1;
        }
    }
    EXPECT_GT(given_up, 5);
}

}  // namespace
}  // namespace stipple
