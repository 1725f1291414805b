#include "decoder/portz2013/patch_matches.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

/// A smooth texture that moves one row down and two columns to the right in a slot.
FluxVideo moving_texture() {
    FluxVideo video(6, {48, 48, 1});
    for (int slot = 0; slot < 6; ++slot)
        for (int row = 0; row < 48; ++row)
            for (int col = 0; col < 48; ++col) {
                const double y = row - slot;
                const double x = col - 2 * slot;
                video.plane(slot, 0)(row, col) = static_cast<float>(
                    0.3 + 0.1 * std::sin(0.5 * x + 0.2 * y) +
                    0.1 * std::sin(0.3 * y - 0.17 * x + 1) + 0.05 * std::sin(0.8 * y + 0.7 * x));
            }
    return video;
}

bool always(double) {
    return true;
}

void follows_blocks(const FluxVideo& video) {
    const MatchList list = find_flow_matches(video, {.radius_slots = 2, .sigma = 1}, always);
    EXPECT_EQ(list.size.rows, 4);
    EXPECT_EQ(list.size.slots, 1);
    int groups = 0, matches = 0, right = 0;
    for (std::size_t g = 0; g < list.groups.size(); ++g) {
        const PatchPosition& at = list.groups[g].reference;
        const PatchMatch& first = list.matches[list.begin_of(g)];
        EXPECT_TRUE(first.slot == at.slot && first.row == at.row && first.col == at.col);
        EXPECT_EQ(first.weight, 1);
        if (at.slot < 2 || at.slot > 3 || at.row < 12 || at.row > 32 || at.col < 12 || at.col > 32)
            continue;
        ++groups;
        for (std::size_t m = list.begin_of(g) + 1; m < list.groups[g].end; ++m, ++matches) {
            const PatchMatch& match = list.matches[m];
            const int slots = match.slot - at.slot;
            right += match.row == at.row + slots && match.col == at.col + 2 * slots;
        }
    }
    EXPECT_EQ(groups, 2 * 36);
    EXPECT_EQ(matches, 4 * groups);
    EXPECT_EQ(right, matches);
}

TEST(FlowMatchesTest, FollowBlocksAlongTheirMotion) {
    follows_blocks(moving_texture());
}

TEST(FlowMatchesTest, FollowHighlightsAboveLight1) {
    FluxVideo video = moving_texture();
    for (float& light : video.data()) light = 1 + 3 * light;
    follows_blocks(video);
}

TEST(FlowMatchesTest, BlocksCoverTheFrameAndSmallFramesStandStill) {
    const MatchList list = find_flow_matches(random_video(2, {7, 9, 3}, 1), {}, always);
    ASSERT_EQ(list.groups.size(), 2U * 2 * 3);
    EXPECT_EQ(list.matches.size(), list.groups.size());
    EXPECT_EQ(list.groups[5].reference.row, 3);
    EXPECT_EQ(list.groups[5].reference.col, 5);
}

TEST(FlowMatchesTest, AreTheSameForAnyNumberOfThreads) {
    const FluxVideo video = moving_texture();
    const auto matches = [&](int threads) {
        const ThreadLimit limit(threads);
        std::vector<float> values;
        for (const PatchMatch& match : find_flow_matches(video, {}, always).matches)
            values.insert(values.end(),
                          {static_cast<float>(match.slot), static_cast<float>(match.row),
                           static_cast<float>(match.col), match.weight});
        return values;
    };
    const auto one = matches(1);
    EXPECT_EQ(one, matches(2));
    EXPECT_EQ(one, matches(3));
}

}  // namespace
}  // namespace stipple
