#include "decoder/data_prox.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "decoder/measurements.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 9, .cols = 37, .planes = 3};
constexpr int kSlots = 33;

struct Problem {
    Measurements measurements;
    std::vector<float> step;
    std::vector<float> v;
};

Problem problem(const ExposureSchedule& schedule) {
    FluxVideo video = random_video(kSlots, kShape, 1);
    for (float& light : video.data()) light *= light * 3;  // some samples saturate
    Problem p{measure(video, schedule), {}, {}};
    p.step = random_values(kSlots * kShape.pixels(), 0.001F, 0.1F, 2);
    p.v = random_values(p.measurements.voxels(), -0.5F, 3, 3);
    return p;
}

void prox_all(const Problem& p, std::span<float> v) {
    for (std::size_t plane = 0; plane < kShape.sites(); plane += kShape.pixels())
        for (std::size_t site = 0; site < kShape.pixels(); site += kMaxRunSites)
            data_prox(p.measurements,
                      {plane + site, plane + std::min(site + kMaxRunSites, kShape.pixels())},
                      p.step, v);
}

/// The minimum is where the gradient is zero: (x - v) / step + w (A x - y) / variance = 0 at each
/// open voxel of weight w, or, where a saturated sample is exceeded, x = v.
TEST(DataProxTest, FulfilsTheConditionOfOptimality) {
    for (const ExposureSchedule& schedule :
         {random_schedule(9, 37, kPaperExposureSlots, 2), gapped_schedule(5, 7, 31, 4),
          interleaved_schedule(5, 7, 9, 4), weighted_schedule(gapped_schedule(5, 7, 31, 4), 5),
          weighted_schedule(interleaved_schedule(5, 7, 9, 4), 6)}) {
        const Problem p = problem(schedule);
        const Measurements& m = p.measurements;
        std::vector<float> x = p.v;
        prox_all(p, x);
        std::size_t exceeded = 0, pulled_up = 0;
        for (std::size_t last = 0; last < m.voxels(); ++last) {
            if ((m.state[last] & Measurements::kLast) == 0) continue;
            double sum_v = 0, sum_x = 0;
            std::vector<std::size_t> open;
            for (std::size_t i = last;; i -= kShape.sites()) {
                if (((m.state[i] ^ m.state[last]) & Measurements::kSecond) != 0) continue;
                if ((m.state[i] & Measurements::kOpen) != 0) open.push_back(i);
                if ((m.state[i] & Measurements::kFirst) != 0) break;
            }
            for (const std::size_t i : open) {
                const auto weight = static_cast<double>(m.weight_at(i));
                sum_v += weight * static_cast<double>(p.v[i]);
                sum_x += weight * static_cast<double>(x[i]);
            }
            const bool saturated = (m.state[last] & Measurements::kSaturated) != 0;
            const bool inactive = saturated && sum_v >= static_cast<double>(m.sum[last]);
            exceeded += inactive;
            pulled_up += saturated && !inactive;
            for (const std::size_t i : open) {
                const std::size_t pixel =
                    i / kShape.sites() * kShape.pixels() + i % kShape.pixels();
                const double prior = (static_cast<double>(x[i]) - static_cast<double>(p.v[i])) /
                                     static_cast<double>(p.step[pixel]);
                const double data = static_cast<double>(m.weight_at(i)) *
                                    (sum_x - static_cast<double>(m.sum[last])) /
                                    static_cast<double>(m.variance[last]);
                // Cancellation in x - v and A x - y: a few units of 2^-24 of values up to 30.
                const double tolerance = 4e-6 / static_cast<double>(p.step[pixel]) +
                                         1e-5 / static_cast<double>(m.variance[last]);
                EXPECT_NEAR(prior + (inactive ? 0 : data), 0, tolerance);
            }
        }
        EXPECT_GT(exceeded, 5U);
        EXPECT_GT(pulled_up, 5U);
    }
}

TEST(DataProxTest, LeavesUnobservedVoxelsAlone) {
    const Problem p = problem(gapped_schedule(5, 7, 31, 4));
    std::vector<float> x = p.v;
    prox_all(p, x);
    std::size_t unobserved = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if ((p.measurements.state[i] & Measurements::kOpen) != 0) continue;
        ++unobserved;
        EXPECT_EQ(x[i], p.v[i]);
    }
    EXPECT_GT(unobserved, 100U);
}

TEST(DataProxTest, GivesTheSameBitsOnEverySimdTarget) {
    for (const ExposureSchedule& schedule :
         {random_schedule(9, 37, kPaperExposureSlots, 2), interleaved_schedule(5, 7, 9, 4),
          weighted_schedule(gapped_schedule(5, 7, 31, 4), 5)}) {
        const Problem p = problem(schedule);
        std::vector<float> first;
        for_each_simd_target([&](const std::string& target) {
            std::vector<float> x = p.v;
            prox_all(p, x);
            if (first.empty()) first = x;
            EXPECT_EQ(x, first) << target;
        });
    }
}

}  // namespace
}  // namespace stipple
