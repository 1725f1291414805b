#include "decoder/portz2013/match_operator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/parallel.h"
#include "tests/decoder/hand_made.h"
#include "tests/decoder/portz2013/factorised_solution.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

/// One slot of a row of pixels, each with a sample of 1 slot, all matches of pixel 0.
struct MedianProblem {
    std::vector<HandSample> samples;
    MatchList matches{{1, 1, 1}, {}, {}};

    void add(float light, float weight, bool saturated = false) {
        const auto col = static_cast<std::int16_t>(samples.size());
        samples.push_back({samples.size(), 0, 1, light, saturated});
        matches.matches.push_back({0, 0, col, weight});
    }
    /// The light of pixel 0 that ADMM finds.
    float solve() {
        matches.groups = {{{0, 0, 0}, matches.matches.size()}};
        const FrameShape shape{1, static_cast<int>(samples.size()), 1};
        const ExposureTable table(hand_made(1, shape, samples));
        const std::array lists{matches};
        MatchOperator problem(table, lists, 0);
        std::vector<float> x(problem.voxels(), 0.5F);
        minimise_by_admm(
            problem, {.iterations = 2000, .rho = 20, .cg_iterations = 10, .cg_tolerance = 0},
            [](int, double) { return true; }, [] { return true; }, x);
        return x[0];
    }
};

TEST(MatchAdmmTest, OfOnePixelFindsTheWeightedMedian) {
    // sum_j w_j |x - y_j| is least where the weights from below reach half of the whole, 0.775.
    MedianProblem problem;
    problem.add(0.1F, 0.2F);
    problem.add(0.9F, 0.4F);
    problem.add(0.3F, 0.3F);
    problem.add(0.7F, 0.35F);
    problem.add(0.6F, 0.3F);
    EXPECT_NEAR(problem.solve(), 0.6F, 1e-3F);
}

TEST(MatchAdmmTest, ASaturatedSampleOnlyPushesUp) {
    MedianProblem problem;
    problem.add(0.2F, 0.5F);
    problem.add(0.4F, 0.2F);
    problem.add(0.8F, 0.4F);
    EXPECT_NEAR(problem.solve(), 0.4F, 1e-3F);
    // A bound of 0.1 is met by 0.4 or any more and changes nothing; as a sample it would make 0.2.
    problem.add(0.1F, 0.5F, true);
    EXPECT_NEAR(problem.solve(), 0.4F, 1e-3F);
    // A bound of 0.7 with more weight than all that lies below it.
    problem.add(0.7F, 0.9F, true);
    EXPECT_NEAR(problem.solve(), 0.7F, 1e-3F);
}

/// Noisy samples of a random clip.
Measurements random_samples(int slots, FrameShape shape) {
    return measure(random_video(slots, shape, 2),
                   random_schedule(shape.rows, shape.cols, kPaperExposureSlots, 1));
}

/// Four matches of each patch, and itself.
std::array<MatchList, 1> matches_of(const ExposureTable& table) {
    return {find_matches(
        {table.slots(), table.shape()}, {.size = {6, 6, 4}, .sigma = 1},
        [&](const PatchSize& size, const PatchPosition& a, const PatchPosition& b, float bound) {
            return patch_distance(table, size, a, b, bound);
        },
        [](const PatchSize&, const PatchPosition&) { return 4; }, [](double) { return true; })};
}

TEST(MatchAdmmTest, MakesTheObjectiveFall) {
    const ExposureTable table(random_samples(16, {16, 16, 1}));
    const std::array lists = matches_of(table);
    const auto solve = [&](int threads, std::vector<double>& objectives) {
        const ThreadLimit limit(threads);
        MatchOperator problem(table, lists, 0.5F);
        std::vector<float> x(problem.voxels());
        minimise_by_admm(
            problem, {.iterations = 30, .rho = 5},
            [&](int iteration, double objective) {
                EXPECT_EQ(static_cast<std::size_t>(iteration), objectives.size());
                objectives.push_back(objective);
                return true;
            },
            [] { return true; }, x);
        return x;
    };
    std::vector<double> objectives, again;
    const auto x = solve(1, objectives);
    ASSERT_EQ(objectives.size(), 30U);
    EXPECT_LT(objectives.back(), objectives.front());
    EXPECT_LT(objectives.back(), objectives[10] * 1.001);
    EXPECT_EQ(x, solve(2, again)) << "the same bits with two threads";
    EXPECT_EQ(objectives, again);
}

/// M = K^T K, which is symmetric, row by row.
std::vector<double> normal_matrix(MatchOperator& k) {
    std::vector<double> m;
    std::vector<float> unit(k.voxels()), row(k.voxels());
    for (std::size_t i = 0; i < k.voxels(); ++i) {
        std::ranges::fill(unit, 0.0F);
        unit[i] = 1;
        k.normal(unit, row);
        m.insert(m.end(), row.begin(), row.end());
    }
    return m;
}

double norm(const std::vector<double>& values) {
    return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0));
}

TEST(MatchAdmmTest, SolvesAsTheMatrixFormedAndFactorised) {
    const ExposureTable table(random_samples(12, {8, 8, 1}));
    const std::array lists = matches_of(table);
    MatchOperator k(table, lists, 0.5F);
    const MatchAdmmOptions options{
        .iterations = 1, .rho = 2, .cg_iterations = 1000, .cg_tolerance = 1e-6F};
    std::vector<float> x(k.voxels(), 0.5F), v(k.rows()), d(k.voxels());
    k.start_duals(x, v);
    k.right_hand_side(v, 1 / options.rho, d);
    minimise_by_admm(
        k, options, [](int, double) { return true; }, [] { return true; }, x);

    const std::vector<double> right(d.begin(), d.end());
    const FactorisedSolution solution = solve_factorised(normal_matrix(k), right);
    // |x - M^-1 d| <= |M x - d| / the least eigenvalue of M.
    const double bound = 1e-6 * norm(right) / solution.least_eigenvalue;
    EXPECT_LT(bound, 0.01 * norm(solution.x));
    std::vector<double> error(solution.x);
    for (std::size_t i = 0; i < error.size(); ++i) error[i] -= static_cast<double>(x[i]);
    EXPECT_LE(norm(error), bound);
}

TEST(MatchAdmmTest, StopsWhenTold) {
    MedianProblem problem;
    problem.add(0.5F, 1);
    problem.matches.groups = {{{0, 0, 0}, 1}};
    const ExposureTable table(hand_made(1, {1, 1, 1}, problem.samples));
    const std::array lists{problem.matches};
    MatchOperator k(table, lists, 0);
    std::vector<float> x(1);
    int iterations = 0;
    minimise_by_admm(
        k, {.iterations = 100}, [&](int, double) { return ++iterations < 3; }, [] { return true; },
        x);
    EXPECT_EQ(iterations, 3);
    minimise_by_admm(
        k, {.iterations = 100}, [&](int, double) { return ++iterations < 100; },
        [] { return false; }, x);
    EXPECT_EQ(iterations, 3);
}

}  // namespace
}  // namespace stipple
