#include "decoder/forward_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/data_prox.h"
#include "decoder/sampling_operator.h"

namespace stipple {
namespace {

/// Logarithm of the normal distribution below z, and its derivative. Below -30 by the first terms
/// of the asymptotic series, as the distribution underflows (Abramowitz and Stegun 26.2.12).
struct LogNormal {
    double value;
    double slope;
};
LogNormal log_normal(double z) {
    const double log_density = -0.5 * z * z - 0.5 * std::log(2 * std::numbers::pi);
    if (z < -30) {
        const double series = 1 - 1 / (z * z);
        return {log_density - std::log(-z) + std::log(series), -z / series};
    }
    const double below = 0.5 * std::erfc(-z / std::numbers::sqrt2);
    return {std::log(below), std::exp(log_density) / below};
}

/// A sample whose light is `mean` according to the model.
struct ModelledSample {
    std::uint8_t state;
    double y;
    double mean;
    double variance;
    double variance_slope;  ///< per unit of `mean`
};

/// Distance of a bound in standard deviations, positive where the light keeps it.
double distance(const ModelledSample& it) {
    const double above = (it.mean - it.y) / std::sqrt(it.variance);
    return (it.state & Measurements::kSaturated) != 0 ? above : -above;
}

bool is_bound(const ModelledSample& it) {
    return (it.state & (Measurements::kSaturated | Measurements::kZero)) != 0;
}

double log_likelihood_of(const ModelledSample& it) {
    if (is_bound(it)) return log_normal(distance(it)).value;
    const double error = it.y - it.mean;
    return -0.5 * (error * error / it.variance + std::log(2 * std::numbers::pi * it.variance));
}

double score_of(const ModelledSample& it) {
    if (is_bound(it)) {
        const double z = distance(it);
        const double sign = (it.state & Measurements::kSaturated) != 0 ? 1 : -1;
        return log_normal(z).slope *
               (sign / std::sqrt(it.variance) - 0.5 * z * it.variance_slope / it.variance);
    }
    const double error = (it.y - it.mean) / it.variance;
    return error + 0.5 * it.variance_slope * (error * error - 1 / it.variance);
}

/// Calls body(voxel, ModelledSample) for each sample if the light is x.
template <typename Body>
void for_each_sample(const ForwardModel& model, std::span<const float> x, const Body& body) {
    const Measurements& m = model.measurements();
    std::vector<float> mean(m.voxels()), variance(m.voxels());
    model.forward(x, mean);
    model.noise_variance(x, variance);
    for (std::size_t i = 0; i < m.voxels(); ++i) {
        if ((m.state[i] & Measurements::kLast) == 0) continue;
        const float slope =
            m.dark_variance.empty() ? model.noise().per_light() : m.variance_per_light[i];
        const auto wide = [](float value) { return static_cast<double>(value); };
        body(i, ModelledSample{.state = m.state[i],
                               .y = wide(m.sum[i]),
                               .mean = wide(mean[i]),
                               .variance = wide(variance[i]),
                               .variance_slope = mean[i] > 0 ? wide(slope) : 0.0});
    }
}

}  // namespace

ForwardModel::ForwardModel(Measurements measurements, const Calibration& calibration)
    : measurements_(std::move(measurements)), noise_(calibration) {
    if (measurements_.slots > kMaxRunSlots)
        throw InputError("slots",
                         fmt::format("{} are more than {}", measurements_.slots, kMaxRunSlots));
    measurements_.zero_is_bound = true;
    const float half_dn = 0.5F * noise_.lsb_light();
    for (std::size_t i = 0; i < measurements_.voxels(); ++i)
        if ((measurements_.state[i] & Measurements::kZero) != 0) measurements_.sum[i] += half_dn;
}

float ForwardModel::variance_of(std::size_t voxel, float light) const {
    return measurements_.dark_variance.empty() ? noise_.variance(light)
                                               : measurements_.variance_at(voxel, light);
}

void ForwardModel::set_samples(std::span<const float> y) {
    assert(y.size() == measurements_.voxels());
    for (std::size_t i = 0; i < y.size(); ++i) {
        std::uint8_t& state = measurements_.state[i];
        if ((state & Measurements::kLast) == 0) continue;
        state &= static_cast<std::uint8_t>(~(Measurements::kSaturated | Measurements::kZero));
        measurements_.sum[i] = y[i];
        measurements_.variance[i] = variance_of(i, y[i]);
    }
}

void ForwardModel::set_variances(std::span<const float> x) {
    refresh_variances(measurements_, noise_, x);
}

void ForwardModel::forward(std::span<const float> x, std::span<float> y) const {
    sample(measurements_, x, y);
}

void ForwardModel::adjoint(std::span<const float> y, std::span<float> x) const {
    spread(measurements_, y, x);
}

void ForwardModel::prox(std::span<const float> step, std::span<float> v) const {
    const std::vector<SiteRun> runs = site_runs(measurements_.shape);
    parallel_for(0, static_cast<int>(runs.size()),
                 [&](int run) { data_prox(measurements_, runs[index(run)], step, v); });
}

void ForwardModel::noise_variance(std::span<const float> x, std::span<float> variance) const {
    forward(x, variance);
    for (std::size_t i = 0; i < variance.size(); ++i)
        if ((measurements_.state[i] & Measurements::kLast) != 0)
            variance[i] = variance_of(i, variance[i]);
}

double ForwardModel::log_likelihood(std::span<const float> x) const {
    double sum = 0;
    for_each_sample(*this, x,
                    [&](std::size_t, const ModelledSample& it) { sum += log_likelihood_of(it); });
    return sum;
}

void ForwardModel::score(std::span<const float> x, std::span<float> gradient) const {
    std::vector<float> at_samples(measurements_.voxels());
    for_each_sample(*this, x, [&](std::size_t voxel, const ModelledSample& it) {
        at_samples[voxel] = static_cast<float>(score_of(it));
    });
    adjoint(at_samples, gradient);
}

}  // namespace stipple
