#include "decoder/sampling_operator.h"
#include "decoder/pixel_response.h"

#include <gtest/gtest.h>

#include <cmath>

#include "decoder/measurements.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 13, .cols = 29, .planes = 3};

std::vector<ExposureSchedule> schedules() {
    return {random_schedule(13, 29, kPaperExposureSlots, 2),
            gapped_schedule(5, 7, 31, 4),
            interleaved_schedule(5, 7, 9, 4),
            alternating_schedule(),
            weighted_schedule(gapped_schedule(5, 7, 31, 4), 5),
            weighted_schedule(interleaved_schedule(5, 7, 9, 4), 6)};
}

TEST(SamplingOperatorTest, SpreadIsTheAdjointOfSample) {
    for (const ExposureSchedule& schedule : schedules()) {
        const FluxVideo video = random_video(35, kShape, 1);
        const Measurements m = measure(video, schedule);
        const auto x = random_values(m.voxels(), -1, 1, 7);
        auto y = random_values(m.voxels(), -1, 1, 8);
        for (std::size_t i = 0; i < y.size(); ++i)
            if ((m.state[i] & Measurements::kLast) == 0) y[i] = 0;
        std::vector<float> forward(m.voxels()), adjoint(m.voxels());
        sample(m, x, forward);
        spread(m, y, adjoint);
        // Sums of at most 12 floats each: 12 half units in the last place of products below 12.
        const double scale = std::sqrt(dot(forward, forward) * dot(y, y));
        EXPECT_NEAR(dot(forward, y), dot(x, adjoint), 1e-6 * scale);
        EXPECT_GT(scale, 100);
    }
}

TEST(SamplingOperatorTest, SampleAfterSpreadSumsTheSquaredWeights) {
    for (const ExposureSchedule& schedule : schedules()) {
        const Measurements m = measure(random_video(35, kShape, 1), schedule);
        std::vector<float> ones(m.voxels()), spread_ones(m.voxels()), count(m.voxels());
        for (std::size_t i = 0; i < m.voxels(); ++i)
            ones[i] = (m.state[i] & Measurements::kLast) != 0 ? 1.0F : 0.0F;
        spread(m, ones, spread_ones);
        sample(m, spread_ones, count);
        double squares = 0;
        for (std::size_t i = 0; i < m.voxels(); ++i) {
            EXPECT_EQ(spread_ones[i],
                      (m.state[i] & Measurements::kOpen) != 0 ? m.weight_at(i) : 0.0F);
            squares += static_cast<double>(count[i]);
        }
        // Without weights both are whole numbers, hence exact.
        EXPECT_NEAR(squares, dot(spread_ones, spread_ones),
                    schedule.weighted() ? 1e-6 * squares : 0);
    }
}

TEST(SamplingOperatorTest, SampleOfTheTruthIsTheMeasurementButForNoise) {
    SensorParams params;
    params.photons_per_unit = 1e4;  // so much light that noise is 1 percent
    params.full_scale_e = 2e5;
    params.full_well_e = 1e6;
    params.bit_depth = 12;
    const FluxVideo video = random_video(35, kShape, 1);
    for (const ExposureSchedule& schedule : schedules()) {
        const Measurements m = measure(video, schedule, params);
        std::vector<float> sums(m.voxels());
        sample(m, video.data(), sums);
        for (std::size_t i = 0; i < m.voxels(); ++i) {
            if ((m.state[i] & Measurements::kLast) == 0) continue;
            EXPECT_NEAR(sums[i], m.sum[i], 6 * std::sqrt(m.variance[i]));  // 1 in 10^9
        }
    }
}

TEST(SamplingOperatorTest, VariancesFollowTheEstimate) {
    const FluxVideo video = random_video(35, kShape, 1);
    Measurements m = measure(video, schedules()[0]);
    const SampleNoise noise{Calibration{}};
    std::vector<float> sums(m.voxels());
    sample(m, video.data(), sums);
    refresh_variances(m, noise, video.data());
    for (std::size_t i = 0; i < m.voxels(); ++i)
        EXPECT_EQ(m.variance[i],
                  (m.state[i] & Measurements::kLast) != 0 ? noise.variance(sums[i]) : 0);
}

}  // namespace
}  // namespace stipple
