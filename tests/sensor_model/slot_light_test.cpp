#include "sensor_model/slot_light.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "core/parallel.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 5, .cols = 7, .planes = 2};

std::vector<float> frame_of(float value) {
    return std::vector<float>(kShape.sites(), value);
}

/// One lit pixel in the second plane.
std::vector<float> point(int row, int col) {
    std::vector<float> frame(kShape.sites());
    frame[kShape.pixels() + static_cast<std::size_t>(row * kShape.cols + col)] = 1;
    return frame;
}

std::vector<float> copy(std::span<const float> light) {
    return {light.begin(), light.end()};
}

double sum(std::span<const float> light) {
    return std::accumulate(light.begin(), light.end(), 0.0);
}

TEST(SlotLightTest, IsTheSceneWithoutTerms) {
    EXPECT_FALSE(SlotLight::changes({}));
    SlotLight light({}, kShape);
    EXPECT_EQ(copy(light.arriving(point(2, 3))), point(2, 3));
}

TEST(SlotLightTest, CrosstalkGivesEachNeighbourAQuarterOfItsFraction) {
    EXPECT_TRUE(SlotLight::changes({.crosstalk = 0.5}));
    SlotLight light({.crosstalk = 0.5}, kShape);
    std::vector<float> expected(kShape.sites());
    const std::size_t at = kShape.pixels() + 2 * 7 + 3;
    expected[at] = 0.5F;
    for (const std::size_t neighbour : {at - 7, at + 7, at - 1, at + 1})
        expected[neighbour] = 0.125F;
    EXPECT_EQ(copy(light.arriving(point(2, 3))), expected);
}

TEST(SlotLightTest, CrosstalkKeepsAllLightAtTheEdgesToo) {
    SlotLight light({.crosstalk = 0.5}, kShape);
    for (const auto& [row, col] : {std::pair{0, 0}, {4, 6}, {0, 3}, {2, 6}})
        EXPECT_EQ(sum(light.arriving(point(row, col))), 1.0) << row << ", " << col;
    EXPECT_EQ(copy(light.arriving(frame_of(3))), frame_of(3));
}

TEST(SlotLightTest, RowSkewDelaysARowInProportionToItsNumber) {
    EXPECT_TRUE(SlotLight::changes({.row_skew_slots = 1}));
    SlotLight light({.row_skew_slots = 1}, kShape);
    EXPECT_EQ(copy(light.arriving(frame_of(8))), frame_of(8));
    const auto step = light.arriving(frame_of(0));
    for (int row = 0; row < kShape.rows; ++row)
        EXPECT_EQ(step[static_cast<std::size_t>(row * kShape.cols)],
                  8 * static_cast<float>(row) / 4)
            << row;
    EXPECT_EQ(copy(light.arriving(frame_of(0))), frame_of(0));
}

TEST(SlotLightTest, OverflowReachesTheNeighbours) {
    EXPECT_TRUE(SlotLight::changes({.blooming = 0.5}));
    SlotLight light({.blooming = 0.5}, kShape);
    (void)light.arriving(frame_of(2));
    const auto bloomed = light.with_overflow(point(2, 3));
    const std::size_t at = kShape.pixels() + 2 * 7 + 3;
    EXPECT_EQ(bloomed[at], 2);
    EXPECT_EQ(bloomed[at - 7], 2.125F);
    EXPECT_EQ(bloomed[at + 1], 2.125F);
    EXPECT_EQ(bloomed[at + 2], 2);
}

TEST(SlotLightTest, GivesTheSameBitsForAnyNumberOfThreads) {
    std::vector<float> frame(kShape.sites());
    for (std::size_t i = 0; i < frame.size(); ++i) frame[i] = static_cast<float>(i % 13) / 7;
    const auto with_threads = [&](int threads) {
        const ThreadLimit limit(threads);
        SlotLight light({.crosstalk = 0.03, .blooming = 0.7, .row_skew_slots = 0.9}, kShape);
        (void)light.arriving(frame_of(1));
        (void)light.arriving(frame);
        return copy(light.with_overflow(frame));
    };
    EXPECT_EQ(with_threads(1), with_threads(2));
}

}  // namespace
}  // namespace stipple
