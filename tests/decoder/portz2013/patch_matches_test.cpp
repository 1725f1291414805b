#include "decoder/portz2013/patch_matches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

bool always(double) {
    return true;
}

/// Matches of a video with itself.
MatchList matches_in(const FluxVideo& video, const MatchSearch& search, int most) {
    return find_matches(
        {video.slots(), video.shape()}, search,
        [&](const PatchSize& size, const PatchPosition& a, const PatchPosition& b, float bound) {
            return patch_difference(video, size, a, b, bound);
        },
        [&](const PatchSize&, const PatchPosition&) { return most; }, always);
}

TEST(PatchMatchesTest, ReferencesCoverTheBlockAndDoNotOverlapInTime) {
    const FluxVideo video = random_video(10, {14, 17, 1}, 1);
    const MatchList list = matches_in(video, {.size = {6, 6, 4}, .step_px = 3}, 0);
    std::vector<int> slots, rows, cols;
    const auto add = [](std::vector<int>& values, int value) {
        if (std::ranges::find(values, value) == values.end()) values.push_back(value);
    };
    for (const MatchGroup& group : list.groups) {
        add(slots, group.reference.slot);
        add(rows, group.reference.row);
        add(cols, group.reference.col);
    }
    EXPECT_EQ(slots, (std::vector{0, 4, 6}))
        << "the last one overlaps, as 10 is not a multiple of 4";
    EXPECT_EQ(rows, (std::vector{0, 3, 6, 8}));
    EXPECT_EQ(cols, (std::vector{0, 3, 6, 9, 11}));
    EXPECT_EQ(list.groups.size(), 60U);
}

TEST(PatchMatchesTest, FindsACopyInItsWindowAndNoFurther) {
    // A random video whose patch at (0, 3, 3) is found again 2 slots, 3 rows and -3 columns away.
    FluxVideo video = random_video(8, {16, 16, 2}, 3);
    for (int slot = 0; slot < 4; ++slot)
        for (int plane = 0; plane < 2; ++plane)
            for (int row = 0; row < 6; ++row)
                for (int col = 0; col < 6; ++col)
                    video.plane(slot + 4, plane)(row + 6, col) =
                        video.plane(slot, plane)(row + 3, col + 3);
    MatchSearch search{.size = {6, 6, 4}, .window_px = 3, .window_slots = 4, .sigma = 0.05F};
    const auto matches = [&] {
        const MatchList list = matches_in(video, search, 12);
        std::size_t group = 0;
        while (list.groups[group].reference.row != 3 || list.groups[group].reference.col != 3)
            ++group;
        return std::vector(list.matches.begin() + static_cast<int>(list.begin_of(group)),
                           list.matches.begin() + static_cast<int>(list.groups[group].end));
    };
    auto found = matches();
    ASSERT_EQ(found.size(), 2U) << "all else is as far as noise from noise, and so no match";
    EXPECT_EQ(found[0].row, 3);
    EXPECT_EQ(found[0].weight, 1);
    EXPECT_EQ(found[1].slot, 4);
    EXPECT_EQ(found[1].row, 6);
    EXPECT_EQ(found[1].col, 0);
    EXPECT_EQ(found[1].weight, 1) << "of equal patches";
    search.with_itself = false;
    EXPECT_EQ(matches().size(), 1U);
    search.window_px = 2;
    EXPECT_EQ(matches().size(), 0U);
}

TEST(PatchMatchesTest, KeepsTheNearestInOrder) {
    const FluxVideo video = random_video(6, {20, 20, 1}, 4);
    const MatchList list =
        matches_in(video, {.size = {4, 4, 2}, .window_px = 8, .window_slots = 4, .sigma = 10}, 7);
    for (std::size_t g = 0; g < list.groups.size(); g += 17) {
        const PatchPosition& reference = list.groups[g].reference;
        const std::size_t begin = list.begin_of(g);
        ASSERT_EQ(list.groups[g].end - begin, 8U);
        for (std::size_t i = begin + 2; i < begin + 8; ++i)
            EXPECT_LE(list.matches[i].weight, list.matches[i - 1].weight);
        const PatchMatch& last = list.matches[begin + 7];
        int nearer = 0;
        for (int slot = std::max(reference.slot - 4, 0); slot <= std::min(reference.slot + 4, 4);
             ++slot)
            for (int row = std::max(reference.row - 8, 0); row <= std::min(reference.row + 8, 16);
                 ++row)
                for (int col = std::max(reference.col - 8, 0);
                     col <= std::min(reference.col + 8, 16); ++col)
                    nearer += match_weight(patch_difference(video, {4, 4, 2}, reference,
                                                            {slot, row, col}, 1e9F),
                                           10) > last.weight;
        EXPECT_LE(nearer, 7) << "itself and six";
    }
}

TEST(PatchMatchesTest, AreTheSameForAnyNumberOfThreads) {
    const FluxVideo video = random_video(6, {20, 20, 1}, 4);
    const auto matches = [&](int threads) {
        const ThreadLimit limit(threads);
        return matches_in(video,
                          {.size = {4, 4, 2}, .window_px = 8, .window_slots = 4, .sigma = 10}, 7)
            .matches;
    };
    const auto one = matches(1);
    const auto two = matches(2);
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].slot, two[i].slot);
        EXPECT_EQ(one[i].row, two[i].row);
        EXPECT_EQ(one[i].col, two[i].col);
        EXPECT_EQ(one[i].weight, two[i].weight);
    }
}

TEST(PatchMatchesTest, PatchesAreCutToASmallBlock) {
    const FluxVideo video = random_video(2, {1, 5, 1}, 4);
    const MatchList list = matches_in(video, {.size = {6, 6, 4}}, 12);
    EXPECT_EQ(list.size.rows, 1);
    EXPECT_EQ(list.size.cols, 5);
    EXPECT_EQ(list.size.slots, 2);
    EXPECT_EQ(list.matches.size(), 1U);
}

TEST(PatchMatchesTest, WeightsAreThoseOfEquation3) {
    EXPECT_FLOAT_EQ(match_weight(0, 0.1F), 1);
    EXPECT_FLOAT_EQ(match_weight(0.02F, 0.1F), std::exp(-1.0F));
}

}  // namespace
}  // namespace stipple
