#include "decoder/portz2013/match_operator.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "core/parallel.h"
#include "decoder/data_prox.h"
#include "tests/decoder/hand_made.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 13, .cols = 17, .planes = 3};
constexpr int kSlots = 35;

/// Patches anywhere, matched with patches anywhere.
MatchList random_matches(const PatchSize& size, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto below = [&](int range) {
        return static_cast<int>(random() % static_cast<unsigned>(range));
    };
    MatchList list{.size = size, .groups = {}, .matches = {}};
    for (int group = 0; group < 40; ++group) {
        const auto where = [&] {
            return PatchPosition{below(kSlots - size.slots + 1), below(kShape.rows - size.rows + 1),
                                 below(kShape.cols - size.cols + 1)};
        };
        const PatchPosition reference = where();
        for (int match = 0; match < 5; ++match) {
            const PatchPosition at = match == 0 ? reference : where();
            list.matches.push_back(
                {static_cast<std::int16_t>(at.slot), static_cast<std::int16_t>(at.row),
                 static_cast<std::int16_t>(at.col), 0.1F * static_cast<float>(1 + below(10))});
        }
        list.groups.push_back({reference, list.matches.size()});
    }
    return list;
}

/// K x of an operator whose residuals are K x - b.
std::vector<float> image(MatchOperator& k, std::span<const float> x) {
    std::vector<float> values(k.rows()), at_zero(k.rows());
    const std::vector<float> zero(x.size());
    k.residuals(x, values);
    k.residuals(zero, at_zero);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] -= at_zero[i];
    return values;
}

std::vector<ExposureSchedule> schedules() {
    return {random_schedule(13, 17, kPaperExposureSlots, 2), gapped_schedule(5, 7, 31, 4),
            interleaved_schedule(5, 7, 9, 4), weighted_schedule(gapped_schedule(5, 7, 31, 4), 5)};
}

TEST(MatchOperatorTest, AdjointsBelongToTheirOperatorsWhateverTheSchedule) {
    for (const ExposureSchedule& schedule : schedules()) {
        const ExposureTable table(measure(random_video(kSlots, kShape, 1), schedule));
        const std::array lists{random_matches({6, 6, 4}, 1), random_matches({4, 4, 1}, 2)};
        MatchOperator k(table, lists, 0.7F);
        ASSERT_GT(k.rows(), 60000U);
        const auto x = random_values(k.voxels(), -1, 1, 7);
        const auto y = random_values(k.rows(), -1, 1, 8);
        const auto kx = image(k, x);
        std::vector<float> kty(k.voxels()), normal(k.voxels()), both(k.voxels());
        k.adjoint(y, kty);
        const double scale = std::sqrt(dot(kx, kx) * dot(y, y));
        // Sums of some hundred floats each.
        EXPECT_NEAR(dot(kx, y), dot(x, kty), 1e-5 * scale);
        k.normal(x, normal);
        k.adjoint(kx, both);
        // A weight of 0.25 makes rows four times, and their squares sixteen times as large.
        const float tolerance = schedule.weighted() ? 16 * 2e-2F : 2e-2F;
        for (std::size_t i = 0; i < normal.size(); ++i)
            ASSERT_NEAR(normal[i], both[i], tolerance) << i;
        EXPECT_NEAR(dot(x, normal), dot(kx, kx), 1e-5 * dot(kx, kx));
    }
}

TEST(MatchOperatorTest, RowsAreTheMatchedSamplesAtThePlaceOfTheReference) {
    // The second pixel's sample of slots 1 and 2, 0.6, at the place of the first, two slots later.
    const ExposureTable table(hand_made(8, {1, 2, 1}, {{1, 1, 0b11, 0.6F}, {0, 0, 0b1111, 1}}));
    const std::array lists{MatchList{{1, 1, 1}, {{{3, 0, 0}, 1}}, {{1, 0, 1, 0.5F}}}};
    MatchOperator k(table, lists, 2);
    ASSERT_EQ(k.rows(), 2U);
    std::vector<float> x(k.voxels()), r(2);
    x[3] = 0.25F;  // first pixel, slots 3 and 4
    x[4] = 0.5F;
    x[8 + 1] = 0.125F;  // second pixel, slot 1
    k.residuals(x, r);
    EXPECT_FLOAT_EQ(r[0], 0.5F * 4 / 2 * (0.75F - 0.6F)) << "weight, tau_max / tau";
    EXPECT_FLOAT_EQ(r[1], 2 * 0.5F * (0.25F - 0.125F)) << "gamma, weight";
}

TEST(MatchOperatorTest, RowsThatReachBeyondTheBlockAreLeftOut) {
    const ExposureTable table(hand_made(6, {1, 2, 1}, {{1, 1, 0b1111, 1}}));
    const auto rows = [&](int slot) {
        const std::array lists{MatchList{{1, 1, 1}, {{{slot, 0, 0}, 1}}, {{2, 0, 1, 1}}}};
        return MatchOperator(table, lists, 1).rows();
    };
    EXPECT_EQ(rows(0), 1U) << "the sample would begin a slot before the block";
    EXPECT_EQ(rows(1), 2U);
    EXPECT_EQ(rows(3), 2U);
    EXPECT_EQ(rows(4), 1U) << "the sample would end a slot after the block";
}

TEST(MatchOperatorTest, OnlyExplainedSaturatedSamplesStartAtTheirResidual) {
    const ExposureTable table(
        hand_made(1, {1, 3, 1}, {{0, 0, 1, 1, true}, {1, 0, 1, 1, true}, {2, 0, 1, 1, false}}));
    MatchList own{{1, 1, 1}, {}, {}};
    for (std::int16_t col = 0; col < 3; ++col) {
        own.matches.push_back({0, 0, col, 1});
        own.groups.push_back({{0, 0, col}, own.matches.size()});
    }
    const std::array lists{own};
    MatchOperator k(table, lists, 1);
    const std::vector<float> x = {3, 0.5F, 3};
    std::vector<float> v(3), d(3);
    k.start_duals(x, v);
    EXPECT_EQ(v, (std::vector<float>{2, 0, 0}));
    k.right_hand_side(v, 0.5F, d);  // b + z - u: nothing pulls the first one down
    EXPECT_EQ(d, (std::vector<float>{3, 1, 1}));
}

TEST(SoftThresholdTest, MinimisesTheNormsAndTheDistance) {
    const float t = 0.3F;
    for (float v = -1; v <= 1; v += 0.0625F) {
        const auto cost = [&](float z) { return std::abs(z) + (z - v) * (z - v) / (2 * t); };
        const auto one_sided = [&](float z) {
            return std::max(-z, 0.0F) + (z - v) * (z - v) / (2 * t);
        };
        const float z = soft_threshold(v, t);
        const float z1 = one_sided_soft_threshold(v, t);
        for (float other = -2; other <= 2; other += 0.01F) {
            EXPECT_LE(cost(z), cost(other) + 1e-6F);
            EXPECT_LE(one_sided(z1), one_sided(other) + 1e-6F);
        }
    }
}

}  // namespace
}  // namespace stipple
