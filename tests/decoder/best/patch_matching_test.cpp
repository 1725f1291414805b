#include "decoder/best/patch_matching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

#include "core/parallel.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 20, .cols = 26, .planes = 1};
constexpr int kSlots = 5;

double difference(const FluxVideo& image, int slot, int row, int col, const PatchOffset& to) {
    double sum = 0;
    for (int r = 0; r < kPatchSide; ++r)
        for (int c = 0; c < kPatchSide; ++c) {
            const auto at = [&](int s, int y, int x) {
                return static_cast<double>(image.plane(s, 0).row(y)[static_cast<std::size_t>(x)]);
            };
            const double d = at(slot, row + r, col + c) -
                             at(slot + to.slots, row + to.rows + r, col + to.cols + c);
            sum += d * d;
        }
    return sum;
}

TEST(ReferenceGridTest, EveryPixelIsInAPatchForEveryStepAndOffset) {
    for (const int side : {6, 7, 11, 12, 26})
        for (int step = 1; step <= kPatchSide; ++step)
            for (int offset = 0; offset < step; ++offset) {
                const ReferenceGrid grid{{side, side, 1}, step, offset};
                std::vector<int> covered(static_cast<std::size_t>(side));
                for (int i = 0; i < grid.rows(); ++i) {
                    ASSERT_GE(grid.row(i), 0);
                    ASSERT_LE(grid.row(i), side - kPatchSide);
                    for (int r = 0; r < kPatchSide; ++r)
                        ++covered[static_cast<std::size_t>(grid.row(i) + r)];
                }
                EXPECT_GT(*std::ranges::min_element(covered), 0)
                    << side << " " << step << " " << offset;
            }
}

TEST(PatchMatchingTest, GroupsAreTheMostSimilarPatchesInReach) {
    const FluxVideo image = random_video(kSlots, kShape, 5);
    const ReferenceGrid grid{kShape, 4, 1};
    const MatchingOptions options{.slots = 1, .own_radius = 2, .path_radius = 1};
    const PatchGroups groups = match_patches(image, grid, {}, options);
    constexpr int kSlot = 2;
    for (int i = 0; i < grid.rows(); ++i)
        for (int j = 0; j < grid.cols(); ++j) {
            std::vector<double> all;
            for (int s = -1; s <= 1; ++s)
                for (int r = -2; r <= 2; ++r)
                    for (int c = -2; c <= 2; ++c) {
                        const int row = grid.row(i) + r;
                        const int col = grid.col(j) + c;
                        if (s != 0 && std::max(std::abs(r), std::abs(c)) > 1) continue;
                        if (row < 0 || col < 0 || row + kPatchSide > kShape.rows ||
                            col + kPatchSide > kShape.cols)
                            continue;
                        all.push_back(
                            difference(image, kSlot, grid.row(i), grid.col(j),
                                       {static_cast<std::int16_t>(s), static_cast<std::int16_t>(r),
                                        static_cast<std::int16_t>(c)}));
                    }
            std::ranges::sort(all);
            const PatchGroup& group = groups.group(kSlot, i, j);
            for (std::size_t k = 0; k < group.size(); ++k)
                EXPECT_NEAR(difference(image, kSlot, grid.row(i), grid.col(j), group[k]), all[k],
                            1e-4);
        }
}

TEST(PatchMatchingTest, AGroupBeginsWithItsReferenceEvenWhereAllIsEqual) {
    const FluxVideo flat(kSlots, kShape);
    const PatchGroups groups = match_patches(flat, {kShape, 5, 0}, {}, {});
    for (const PatchGroup& group : groups.groups) {
        EXPECT_EQ(std::tuple(group[0].slots, group[0].rows, group[0].cols), std::tuple(0, 0, 0));
        std::set<std::tuple<int, int, int>> different;
        for (const PatchOffset& patch : group)
            different.insert({patch.slots, patch.rows, patch.cols});
        EXPECT_EQ(different.size(), group.size());
    }
}

TEST(PatchMatchingTest, TooFewPatchesAreRepeated) {
    const FluxVideo one = random_video(1, {6, 6, 1}, 1);
    const PatchGroups groups = match_patches(one, {{6, 6, 1}, 5, 0}, {}, {});
    ASSERT_EQ(groups.groups.size(), 1U);
    for (const PatchOffset& patch : groups.groups[0])
        EXPECT_EQ(std::tuple(patch.slots, patch.rows, patch.cols), std::tuple(0, 0, 0));
}

/// The image moves by (1, 2) pixels a slot, as the motion says.
TEST(PatchMatchingTest, PatchesAreFoundAlongMotion) {
    constexpr FrameShape kLarge{.rows = 40, .cols = 60, .planes = 1};
    const std::vector<float> world = random_values(60 * 80, 0, 1, 9);
    FluxVideo image(kSlots, kLarge);
    std::vector<MotionField> motion(2);
    motion[1].step = -1;
    for (MotionField& field : motion) {
        const auto unit = static_cast<std::int16_t>(MotionField::kShiftsPerPixel * field.step);
        field.row_shift.assign(image.voxels(), unit);
        field.col_shift.assign(image.voxels(), static_cast<std::int16_t>(2 * unit));
        field.confidence.assign(image.voxels(), 255);
    }
    for (int slot = 0; slot < kSlots; ++slot)
        for (int row = 0; row < kLarge.rows; ++row)
            for (int col = 0; col < kLarge.cols; ++col)
                image.plane(slot, 0).row(row)[static_cast<std::size_t>(col)] =
                    world[static_cast<std::size_t>((row - slot + 8) * 80 + col - 2 * slot + 16)];
    const ReferenceGrid grid{kLarge, 5, 0};
    const PatchGroups groups =
        match_patches(image, grid, motion, {.slots = 4, .own_radius = 1, .path_radius = 0});
    const PatchGroup& group = groups.group(0, 3, 4);  // row 15, col 20
    for (int slot = 0; slot < kSlots; ++slot) {
        const PatchOffset& patch = group[static_cast<std::size_t>(slot)];
        EXPECT_EQ(patch.rows, patch.slots);
        EXPECT_EQ(patch.cols, 2 * patch.slots);
        EXPECT_EQ(difference(image, 0, 15, 20, patch), 0);
    }
}

TEST(PatchMatchingTest, OneAndTwoThreadsFindTheSame) {
    const FluxVideo image = random_video(kSlots, kShape, 6);
    const auto find = [&](int threads) {
        const ThreadLimit limit(threads);
        std::vector<int> all;
        for (const PatchGroup& group : match_patches(image, {kShape, 3, 2}, {}, {}).groups)
            for (const PatchOffset& patch : group)
                all.insert(all.end(), {patch.slots, patch.rows, patch.cols});
        return all;
    };
    EXPECT_EQ(find(1), find(2));
}

}  // namespace
}  // namespace stipple
