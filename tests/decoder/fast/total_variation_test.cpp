#include "decoder/fast/total_variation.h"
#include "decoder/pixel_response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "decoder/fast/motion_tv.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "decoder/sampling_operator.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

/// Every voxel its own sample `y`, all with this variance.
Measurements direct_samples(int slots, FrameShape shape, const std::vector<float>& y,
                            float variance) {
    constexpr std::uint8_t kAll = Measurements::kOpen | Measurements::kFirst | Measurements::kLast;
    return {slots, shape, std::vector<std::uint8_t>(y.size(), kAll), y,
            std::vector<float>(y.size(), variance)};
}

FluxVideo solve(const Measurements& m, TotalVariationOptions options,
                const std::vector<MotionField>& motion = {}) {
    FluxVideo x(m.slots, m.shape);
    const std::vector<float> step(static_cast<std::size_t>(m.slots) * m.shape.pixels(), 0.05F);
    options.reference_step = 0.05F;
    TotalVariationSolver(m).minimise(motion, step, options, x);
    return x;
}

/// Two voxels y1 < y2 of variance s: each moves towards the other by weight * s, or both to their
/// mean, whichever comes first.
TEST(TotalVariationTest, MovesTwoNeighboursByWeightTimesVariance) {
    const float s = 0.01F;
    for (const FrameShape shape : {FrameShape{1, 2, 1}, FrameShape{2, 1, 1}}) {
        const auto far = solve(direct_samples(1, shape, {0.2F, 0.6F}, s),
                               {.iterations = 3000, .spatial_weight = 5});
        EXPECT_NEAR(far.data()[0], 0.2 + 5 * 0.01, 1e-4);
        EXPECT_NEAR(far.data()[1], 0.6 - 5 * 0.01, 1e-4);
        const auto near = solve(direct_samples(1, shape, {0.2F, 0.25F}, s),
                                {.iterations = 3000, .spatial_weight = 5});
        EXPECT_NEAR(near.data()[0], 0.225, 1e-4);
        EXPECT_NEAR(near.data()[1], 0.225, 1e-4);
    }
    const auto in_time = solve(direct_samples(2, {1, 1, 1}, {0.2F, 0.6F}, s),
                               {.iterations = 3000, .temporal_weight = 7});
    EXPECT_NEAR(in_time.data()[0], 0.2 + 7 * 0.01, 1e-4);
    EXPECT_NEAR(in_time.data()[1], 0.6 - 7 * 0.01, 1e-4);
}

/// A quarter of the step doubles the weight.
TEST(TotalVariationTest, WeighsDifferencesOfSmallStepsMore) {
    FluxVideo x(1, {1, 2, 1});
    const Measurements m = direct_samples(1, x.shape(), {0.2F, 0.6F}, 0.01F);
    TotalVariationSolver(m).minimise(
        {}, std::vector<float>(2, 0.05F),
        {.iterations = 3000, .spatial_weight = 5, .reference_step = 0.2F}, x);
    EXPECT_NEAR(x.data()[0], 0.2 + 2 * 5 * 0.01, 1e-4);
}

/// Planes that step by d1 .. d3 share one norm: plane p moves by weight * s * dp / |d|.
TEST(TotalVariationTest, SharesTheNormOverPlanes) {
    const auto x = solve(direct_samples(1, {1, 2, 3}, {0, 0.3F, 0, 0.6F, 0, 0.6F}, 0.01F),
                         {.iterations = 3000, .spatial_weight = 5});
    for (int plane = 0; plane < 3; ++plane) {
        const double d = plane == 0 ? 0.3 : 0.6;
        EXPECT_NEAR(x.plane(0, plane)(0, 0), 5 * 0.01 * d / 0.9, 1e-4);
        EXPECT_NEAR(x.plane(0, plane)(0, 1), d - 5 * 0.01 * d / 0.9, 1e-4);
    }
}

/// Planes step by (d1, d2, d3): luma moves by weight * s, the opponents together by the chroma
/// weight times that. Here the opponents are (0.4, 0) / sqrt(2).
TEST(TotalVariationTest, PricesLumaAndOpponentsApart) {
    const auto x = solve(direct_samples(1, {1, 2, 3}, {0, 0.7F, 0, 0.5F, 0, 0.3F}, 0.01F),
                         {.iterations = 3000, .spatial_weight = 5, .chroma_weight = 2});
    const double luma = 5 * 0.01 / std::sqrt(3);
    const double opponent = 2 * 5 * 0.01 / std::sqrt(2);
    EXPECT_NEAR(x.plane(0, 0)(0, 0), luma + opponent, 1e-4);
    EXPECT_NEAR(x.plane(0, 1)(0, 0), luma, 1e-4);
    EXPECT_NEAR(x.plane(0, 2)(0, 0), luma - opponent, 1e-4);
    EXPECT_NEAR(x.plane(0, 0)(0, 1), 0.7 - luma - opponent, 1e-4);
    const auto in_time = solve(direct_samples(2, {1, 1, 3}, {0, 0, 0, 0.7F, 0.5F, 0.3F}, 0.01F),
                               {.iterations = 3000, .temporal_weight = 5, .chroma_weight = 2});
    EXPECT_NEAR(in_time.data()[0], luma + opponent, 1e-4);
}

/// A link of confidence c from pixel 0 of slot 0 to pixel (1, 1) of slot 1, and no other.
TEST(TotalVariationTest, TiesPartnersAlongMotionAsFarAsItIsTrusted) {
    const FrameShape shape{2, 2, 1};
    MotionField field{.step = 1,
                      .row_shift = std::vector<std::int16_t>(8),
                      .col_shift = std::vector<std::int16_t>(8),
                      .confidence = std::vector<std::uint8_t>(8)};
    field.row_shift[0] = field.col_shift[0] = MotionField::kShiftsPerPixel;
    field.confidence[0] = 51;  // a fifth
    const auto x =
        solve(direct_samples(2, shape, {0.2F, 0.2F, 0.2F, 0.2F, 0.8F, 0.8F, 0.8F, 0.8F}, 0.01F),
              {.iterations = 3000, .spatial_weight = 1e-3F, .temporal_weight = 10}, {field});
    EXPECT_NEAR(x.data()[0], 0.2 + 10 * 0.01 / 5, 1e-3);
    EXPECT_NEAR(x.data()[7], 0.8 - 10 * 0.01 / 5, 1e-3);
    EXPECT_NEAR(x.data()[4], 0.8, 1e-3);
}

/// The objective of total_variation.h without motion, in double.
double objective(const Measurements& m, const TotalVariationOptions& options, const FluxVideo& x) {
    std::vector<float> sums(m.voxels());
    sample(m, x.data(), sums);
    double value = 0;
    for (std::size_t i = 0; i < m.voxels(); ++i) {
        if ((m.state[i] & Measurements::kLast) == 0) continue;
        const double residual = static_cast<double>(m.sum[i]) - static_cast<double>(sums[i]);
        const bool saturated = (m.state[i] & Measurements::kSaturated) != 0;
        if (!saturated || residual > 0)
            value += residual * residual / (2 * static_cast<double>(m.variance[i]));
    }
    for (int slot = 0; slot < x.slots(); ++slot) {
        const auto frame = x.plane(slot, 0);
        for (int row = 0; row < frame.rows(); ++row)
            for (int col = 0; col < frame.cols(); ++col) {
                const auto light = [&](int t, int r, int c) {
                    return static_cast<double>(x.plane(t, 0)(r, c));
                };
                const double here = light(slot, row, col);
                const double right = col + 1 < frame.cols() ? light(slot, row, col + 1) - here : 0;
                const double below = row + 1 < frame.rows() ? light(slot, row + 1, col) - here : 0;
                value += static_cast<double>(options.spatial_weight) * std::hypot(right, below);
                if (slot + 1 < x.slots())
                    value += static_cast<double>(options.temporal_weight) *
                             std::abs(light(slot + 1, row, col) - here);
            }
    }
    return value;
}

TEST(TotalVariationTest, NoNeighbourOfTheSolutionIsBetter) {
    const FrameShape shape{12, 12, 1};
    const Measurements m =
        measure(random_video(24, shape, 1), random_schedule(12, 12, kPaperExposureSlots, 1));
    const TotalVariationOptions options{
        .iterations = 4000, .spatial_weight = 3, .temporal_weight = 2};
    const FluxVideo x = solve(m, options);
    const double best = objective(m, options, x);
    EXPECT_LT(best, objective(m, options, nearest_samples(m)));
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        FluxVideo other = x;
        const auto move = random_values(x.voxels(), -1, 1, seed);
        for (std::size_t i = 0; i < x.voxels(); ++i) other.data()[i] += 0.01F * move[i];
        EXPECT_GT(objective(m, options, other), best);
        // Towards the truth and away from it, along smooth directions.
        for (std::size_t i = 0; i < x.voxels(); ++i)
            other.data()[i] = x.data()[i] * (seed % 2 == 0 ? 1.003F : 0.997F);
        EXPECT_GT(objective(m, options, other), best);
    }
}

/// Light of 1.5 saturates exposures of 2, 4 and 8 slots and not those of 1; a start that believes
/// the saturated ones must not stay there.
TEST(TotalVariationTest, SaturatedAreasReachTheLightOfTheShortExposures) {
    FluxVideo video(32, {.rows = 48, .cols = 48, .planes = 1});
    for (int slot = 0; slot < 32; ++slot)
        for (int row = 0; row < 48; ++row)
            for (int col = 0; col < 48; ++col) {
                const bool bright = std::hypot(row - 24, col - 24) < 14;
                video.plane(slot, 0)(row, col) = bright ? 1.5F : 0.2F;
            }
    Measurements m = measure(video, random_schedule(48, 48, kPaperExposureSlots, 1));
    const FluxVideo x = *decode_motion_tv(m, SampleNoise(Calibration{}), {});
    for (int slot = 4; slot < 28; ++slot) {
        double sum = 0;
        for (int row = 18; row <= 30; ++row)
            for (int col = 18; col <= 30; ++col)
                sum += static_cast<double>(x.plane(slot, 0)(row, col));
        // 45 single-slot samples of relative noise 0.03 and more in the slots around: 1 percent.
        EXPECT_NEAR(sum / 169, 1.5, 0.03) << "slot " << slot;
        EXPECT_NEAR(x.plane(slot, 0)(2, 2), 0.2, 0.03);
    }
}

TEST(TotalVariationTest, GivesTheSameBitsForAnyNumberOfThreads) {
    const FrameShape shape{40, 56, 3};
    const FluxVideo video = random_video(20, shape, 1);
    const auto decoded = [&](int threads) {
        const ThreadLimit limit(threads);
        Measurements m = measure(video, random_schedule(40, 56, kPaperExposureSlots, 1));
        const FluxVideo x = *decode_motion_tv(m, SampleNoise(Calibration{}), {});
        return std::vector<float>(x.data().begin(), x.data().end());
    };
    EXPECT_EQ(decoded(1), decoded(2));
}

}  // namespace
}  // namespace stipple
