#include "decoder/joint/joint_prox.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "core/index.h"
#include "decoder/measurements.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 3, .cols = 11, .planes = 1};
constexpr int kSlots = 33;
/// The rate of the sweeps is at most 0.8 with these steps and variances: 1e-6 after 60.
constexpr int kManySweeps = 200;

struct Problem {
    Measurements measurements;
    std::vector<float> step;
    std::vector<float> v;
};

/// Three sensors with other schedules each; `brightness` decides how many samples are saturated.
Problem problem(float brightness) {
    FluxVideo video = random_video(kSlots, kShape, 1);
    for (float& light : video.data()) light *= brightness;
    Problem p{measure(video, random_schedule(3, 11, kPaperExposureSlots, 2)), {}, {}};
    p.measurements.others.push_back(measure(video, gapped_schedule(3, 11, 31, 4)));
    p.measurements.others.push_back(
        measure(video, weighted_schedule(interleaved_schedule(3, 11, 9, 4), 5)));
    p.step = random_values(kSlots * kShape.pixels(), 0.001F, 0.01F, 2);
    p.v = random_values(p.measurements.voxels(), 0, 2, 3);
    return p;
}

std::vector<float> joint(const Problem& p, int sweeps) {
    JointProx prox(p.measurements);
    std::vector<float> x = p.v;
    prox({0, kShape.sites()}, p.step, x, sweeps);
    return x;
}

/// An exposure of a site as a row of A, with its sample.
struct Row {
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(kSlots);
    double y = 0;
    double variance = 1;
    bool saturated = false;
};

std::vector<Row> rows_of(const Measurements& measurements, std::size_t site) {
    std::vector<Row> rows;
    for_each_sensor(measurements, [&](const Measurements& m) {
        Row chains[2];
        for (int slot = 0; slot < kSlots; ++slot) {
            const std::size_t i = index(slot) * kShape.sites() + site;
            Row& row = chains[(m.state[i] & Measurements::kSecond) != 0 ? 1 : 0];
            if ((m.state[i] & Measurements::kFirst) != 0) row = {};
            if ((m.state[i] & Measurements::kOpen) != 0)
                row.weights(slot) = static_cast<double>(m.weight_at(i));
            if ((m.state[i] & Measurements::kLast) == 0) continue;
            row.y = static_cast<double>(m.sum[i]);
            row.variance = static_cast<double>(m.variance[i]);
            row.saturated = (m.state[i] & Measurements::kSaturated) != 0;
            rows.push_back(row);
        }
    });
    return rows;
}

Eigen::VectorXd column(const std::vector<float>& values, std::size_t site) {
    Eigen::VectorXd result(kSlots);
    for (int slot = 0; slot < kSlots; ++slot)
        result(slot) = static_cast<double>(values[index(slot) * kShape.sites() + site]);
    return result;
}

TEST(JointProxTest, IsTheSolutionOfTheNormalEquations) {
    const Problem p = problem(0.15F);  // nothing is saturated
    const auto x = joint(p, kManySweeps);
    for (std::size_t site = 0; site < kShape.sites(); ++site) {
        const Eigen::VectorXd step = column(p.step, site);
        Eigen::MatrixXd normal = step.cwiseInverse().asDiagonal();
        Eigen::VectorXd right = column(p.v, site).cwiseQuotient(step);
        for (const Row& row : rows_of(p.measurements, site)) {
            ASSERT_FALSE(row.saturated);
            normal += row.weights * row.weights.transpose() / row.variance;
            right += row.weights * row.y / row.variance;
        }
        const Eigen::VectorXd exact = normal.ldlt().solve(right);
        // Sums of up to 8 values of up to 2, in float: some 1e-6.
        EXPECT_LT((exact - column(x, site)).cwiseAbs().maxCoeff(), 2e-5);
    }
}

/// x - v = step sum_k w_k d_k with d_k = (y_k - A x) / variance_k, or 0 where a saturated sample is
/// exceeded.
TEST(JointProxTest, FulfilsTheConditionOfOptimality) {
    const Problem p = problem(3);
    const auto x = joint(p, kManySweeps);
    int exceeded = 0, pulled_up = 0;
    for (std::size_t site = 0; site < kShape.sites(); ++site) {
        Eigen::VectorXd force = Eigen::VectorXd::Zero(kSlots);
        const Eigen::VectorXd solution = column(x, site);
        for (const Row& row : rows_of(p.measurements, site)) {
            const double missing = row.y - row.weights.dot(solution);
            exceeded += row.saturated && missing <= 0;
            pulled_up += row.saturated && missing > 0;
            if (!row.saturated || missing > 0) force += row.weights * missing / row.variance;
        }
        const Eigen::VectorXd moved = column(p.step, site).cwiseProduct(force);
        EXPECT_LT((moved - solution + column(p.v, site)).cwiseAbs().maxCoeff(), 1e-3);
    }
    EXPECT_GT(exceeded, 5);
    EXPECT_GT(pulled_up, 5);
}

TEST(JointProxTest, GoesOnFromCallToCall) {
    const Problem p = problem(0.15F);
    const auto exact = joint(p, kManySweeps);
    JointProx prox(p.measurements);
    std::vector<float> x;
    for (int call = 0; call < kManySweeps / JointProx::kSweeps; ++call) {
        x = p.v;
        prox({0, kShape.sites()}, p.step, x);
    }
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], exact[i], 1e-5);
}

TEST(JointProxTest, HasTheBitsOfOneSensorAlone) {
    Problem p = problem(3);
    p.measurements.others.clear();
    std::vector<float> x = p.v;
    data_prox(p.measurements, {0, kShape.sites()}, p.step, x);
    EXPECT_EQ(joint(p, JointProx::kSweeps), x);
}

TEST(JointProxTest, GivesTheSameBitsOnEverySimdTarget) {
    const Problem p = problem(3);
    std::vector<float> first;
    for_each_simd_target([&](const std::string& target) {
        const auto x = joint(p, JointProx::kSweeps);
        if (first.empty()) first = x;
        EXPECT_EQ(x, first) << target;
    });
}

}  // namespace
}  // namespace stipple
