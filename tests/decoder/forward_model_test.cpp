#include "decoder/forward_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "tests/decoder/recordings.h"
#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 6, .cols = 7, .planes = 1};
constexpr int kSlots = 20;

/// From darkness, where samples are DN 0, to twice the full scale.
FluxVideo wide_video() {
    FluxVideo video = random_video(kSlots, kShape, 3);
    for (std::size_t i = 0; i < video.data().size(); ++i)
        video.data()[i] *= i % 3 == 0 ? 0.002F : i % 3 == 1 ? 0.3F : 2.0F;
    return video;
}

std::vector<ExposureSchedule> schedules() {
    return {random_schedule(6, 7, kPaperExposureSlots, 2), gapped_schedule(5, 7, 13, 4),
            weighted_schedule(gapped_schedule(5, 7, 13, 4), 5), interleaved_schedule(5, 7, 9, 4)};
}

ForwardModel model_of(const FluxVideo& video, const ExposureSchedule& schedule) {
    return {measure(video, schedule), Calibration{}};
}

/// The objective of the proximal map; infinite where a bound is broken by more than rounding.
double objective(const ForwardModel& model, const std::vector<float>& step,
                 const std::vector<float>& v, const std::vector<float>& x) {
    std::vector<float> mean(x.size());
    model.forward(x, mean);
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double move = static_cast<double>(x[i]) - static_cast<double>(v[i]);
        sum += move * move / (2 * static_cast<double>(step[i]));
        const auto state = model.measurements().state[i];
        if ((state & Measurements::kLast) == 0) continue;
        double error = static_cast<double>(model.samples()[i]) - static_cast<double>(mean[i]);
        if ((state & Measurements::kSaturated) != 0) error = std::max(error, 0.0);
        if ((state & Measurements::kZero) != 0) error = std::min(error, 0.0);
        sum += error * error / (2 * static_cast<double>(model.measurements().variance[i]));
    }
    return sum;
}

TEST(ForwardModelTest, NoMoveImprovesTheResultOfProx) {
    for (const ExposureSchedule& schedule : schedules()) {
        const ForwardModel model = model_of(wide_video(), schedule);
        const auto states = model.measurements().state;
        for (const auto bound : {Measurements::kSaturated, Measurements::kZero})
            EXPECT_TRUE(std::ranges::any_of(states, [&](auto s) { return (s & bound) != 0; }));
        const auto v = random_values(states.size(), 0, 1.5, 1);
        const auto step = random_values(states.size(), 0.001F, 0.02F, 2);
        std::vector<float> x = v;
        model.prox(step, x);
        const double best = objective(model, step, v, x);
        EXPECT_LT(best, objective(model, step, v, v));
        for (std::uint32_t seed = 0; seed < 200; ++seed) {
            std::vector<float> other = x;
            const auto moves = random_values(x.size(), -0.01F, 0.01F, seed);
            for (std::size_t i = seed % 5; i < x.size(); i += 1 + seed % 7) other[i] += moves[i];
            // The result has 24 bits; terms of the objective are below 1e4.
            EXPECT_LE(best, objective(model, step, v, other) * (1 + 1e-6)) << seed;
        }
    }
}

TEST(ForwardModelTest, ScoreIsTheGradientOfTheLogLikelihood) {
    for (const ExposureSchedule& schedule : schedules()) {
        const ForwardModel model = model_of(wide_video(), schedule);
        const std::size_t voxels = model.samples().size();
        const auto x = random_values(voxels, 0.05F, 1, 4);
        std::vector<float> gradient(voxels);
        model.score(x, gradient);
        for (std::uint32_t seed = 0; seed < 20; ++seed) {
            const auto way = random_values(voxels, -1, 1, seed + 10);
            constexpr float kStep = 1e-3F;
            std::vector<float> more = x, less = x;
            for (std::size_t i = 0; i < voxels; ++i) {
                more[i] += kStep * way[i];
                less[i] -= kStep * way[i];
            }
            const double expected = (model.log_likelihood(more) - model.log_likelihood(less)) /
                                    (2 * static_cast<double>(kStep));
            EXPECT_NEAR(dot(gradient, way), expected, 1e-3 * std::sqrt(dot(gradient, gradient)));
        }
    }
}

TEST(ForwardModelTest, TheTruthIsMoreLikelyThanOtherLight) {
    const FluxVideo truth = random_video(kSlots, kShape, 3);
    const ForwardModel model = model_of(truth, schedules()[0]);
    const std::vector<float> light(truth.data().begin(), truth.data().end());
    for (const float factor : {0.9F, 1.1F}) {
        std::vector<float> other = light;
        for (float& value : other) value *= factor;
        EXPECT_GT(model.log_likelihood(light), model.log_likelihood(other) + 10);
    }
}

TEST(ForwardModelTest, OtherSamplesAreNoBounds) {
    ForwardModel model = model_of(wide_video(), schedules()[0]);
    std::vector<float> y(model.samples().size(), 0.5F);
    model.set_samples(y);
    for (std::size_t i = 0; i < y.size(); ++i) {
        const auto state = model.measurements().state[i];
        EXPECT_EQ(state & (Measurements::kSaturated | Measurements::kZero), 0);
        EXPECT_EQ(model.samples()[i], (state & Measurements::kLast) != 0 ? 0.5F : 0.0F);
    }
}

TEST(ForwardModelTest, RefusesMoreSlotsThanARunHas) {
    const FluxVideo video = random_video(129, {.rows = 1, .cols = 1, .planes = 1}, 1);
    EXPECT_THROW(model_of(video, random_schedule(1, 1, kPaperExposureSlots, 1)), InputError);
}

}  // namespace
}  // namespace stipple
