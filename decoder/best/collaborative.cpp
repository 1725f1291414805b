#include "decoder/best/collaborative.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <list>
#include <utility>
#include <vector>

#include "core/config.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/best/patch_denoiser.h"
#include "decoder/data_prox.h"
#include "decoder/fast/censored_samples.h"
#include "decoder/fast/motion_tv.h"
#include "decoder/joint/joint_prox.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"
#include "decoder/pixel_transforms.h"
#include "decoder/sampling_operator.h"

namespace stipple {
namespace {

constexpr double kStartShare = 0.15;  // of all work; for the progress
constexpr float kMaxOffset = 1e3F;    // flux; where noise is larger than that, light is not seen
constexpr float kMaxSigma = 10;

/// Half-quadratic splitting of one block.
class SplittingSolver {
  public:
    SplittingSolver(const SplittingTask& task, const CollaborativeOptions& options,
                    Denoiser denoiser, FluxVideo& x)
        : measurements_(task.measurements),
          noise_(task.noise),
          options_(options),
          denoiser_(std::move(denoiser)),
          scale_(scale_for(noise_, options)),
          last_sigma_(std::clamp(options.last_noise * std::sqrt(noise_.per_light()),
                                 options.min_sigma, kMaxSigma)),
          first_sigma_(std::max(options.first_sigma, last_sigma_)),
          x_(x),
          noisy_(x.slots(), x.shape()),
          filtered_(x.slots(), x.shape()),
          pilot_(x.slots(), x.shape()),
          runs_(site_runs(x.shape())),
          step_(index(x.slots()) * x.shape().pixels()),
          prox_(measurements_),
          samples_per_voxel_(samples_per_voxel(measurements_)) {
        for_each_sensor(measurements_,
                        [&](Measurements& sensor) { sensors_.emplace_back(sensor, noise_); });
    }

    /// Denoises the estimate. All iterations but the last end with the data-consistency step.
    void iterate(int iteration) {
        const float sigma = sigma_of(iteration);

        // z = 2 sqrt(x + offset), without its noise of sigma.
        for_each_slot([&](int slot) {
            stabilise_variance(std::as_const(x_).frame(slot), shape().planes, scale_,
                               noisy_.frame(slot));
        });
        if (iteration == 0) pilot_ = noisy_;
        denoiser_({iteration, sigma, x_, noisy_, pilot_}, filtered_);
        std::swap(filtered_, pilot_);

        // z_k + beta (z_k - z_(k-1)), and back to light: x = z^2 / 4 - offset.
        const bool last = iteration + 1 == options_.iterations;
        if (!last) extrapolate();
        for_each_slot([&](int slot) {
            restore_light(std::as_const(last ? pilot_ : filtered_).frame(slot), shape().planes,
                          scale_, x_.frame(slot));
        });
        refresh_variances(measurements_, noise_, x_.data());
        if (last) return;

        // y <- y0 + decay (y - y0) + gain (y0 - Ax), then prox of the data term at x.
        for (Sensor& sensor : sensors_) {
            sensor.censored.expect(x_.data(), sensor.sampled);
            add_residuals(sensor);
        }
        enforce_data_consistency(sigma);
    }
    void restore_samples() {
        for (Sensor& sensor : sensors_) sensor.measurements.sum = sensor.sampled;
    }

  private:
    struct Sensor {
        Sensor(Measurements& m, const SampleNoise& noise)
            : measurements(m), censored(m, noise), sampled(m.sum) {}
        Measurements& measurements;
        CensoredSamples censored;
        std::vector<float> sampled;  ///< sums of the samples, without their residuals
    };

    [[nodiscard]] FrameShape shape() const { return x_.shape(); }

    static AnscombeParams scale_for(const SampleNoise& noise, const CollaborativeOptions& options) {
        const float offset =
            std::clamp(noise.variance(0) / noise.per_light() / options.offset_slots,
                       options.light_offset, kMaxOffset);
        return {.offset = offset, .min_light = std::max(options.min_light, -offset)};
    }

    template <typename Body>
    void for_each_slot(const Body& body) {
        parallel_for(0, x_.slots(), body);
    }

    /// In steps of 2^-20, so that its bits do not hang on a library's power.
    [[nodiscard]] float sigma_of(int iteration) const {
        const double done = static_cast<double>(iteration) / std::max(1, options_.iterations - 1);
        const double first = static_cast<double>(first_sigma_);
        const double sigma = first * std::pow(static_cast<double>(last_sigma_) / first, done);
        return static_cast<float>(std::round(sigma * 0x1p20) * 0x1p-20);
    }

    /// Momentum (heavy ball; Polyak, USSR Comput. Math. Math. Phys. 4(5), 1964): the last filtered
    /// estimate x_k becomes x_k + beta (x_k - x_(k-1)). Voxels without samples converge slowly
    /// without it.
    void extrapolate() {
        for_each_slot([&](int slot) {
            const auto now = std::as_const(pilot_).frame(slot);
            const auto before = filtered_.frame(slot);
            for (std::size_t i = 0; i < now.size(); ++i)
                before[i] = now[i] + options_.momentum * (now[i] - before[i]);
        });
    }

    /// Residual feedback: a share of (samples - forward model of the estimate) is added to the
    /// samples, as in generalised alternating projection (Liao et al., SIAM J. Imaging Sci. 7(2),
    /// 2014). What was added decays, so that the noise does not return; the gain is that of
    /// residual_part. Without decay all of the residuals is added in the end, noise too, and the
    /// gain is the length of a step. The residuals of several sensors add up in a voxel, so each
    /// has its part of the gain.
    void add_residuals(Sensor& sensor) {
        Measurements& m = sensor.measurements;
        const float gain = options_.residual_gain / static_cast<float>(sensors_.size());
        const bool by_noise = options_.residual_decay < 1;
        FluxVideo& explained = noisy_;  // which is not needed until the next iteration
        sample(m, x_.data(), explained.data());
        for_each_slot([&](int slot) {
            const std::size_t begin = index(slot) * shape().sites();
            for (std::size_t i = begin; i < begin + shape().sites(); ++i) {
                const bool saturated = (m.state[i] & Measurements::kSaturated) != 0;
                const float sampled = sensor.sampled[i];
                float residual = sampled - explained.data()[i];
                if (saturated) residual = std::max(residual, 0.0F);
                const float dark =
                    m.dark_variance.empty() ? noise_.variance(0) : m.dark_variance[i];
                const float part = by_noise ? residual_part(samples_per_voxel_, explained.data()[i],
                                                            dark, m.variance[i])
                                            : 1;
                float& sum = m.sum[i];
                sum = sampled + options_.residual_decay * (sum - sampled) + gain * part * residual;
            }
        });
    }

    void enforce_data_consistency(float sigma) {
        const float variance = options_.data_step * sigma * sigma;
        for_each_slot([&](int slot) {
            const std::size_t pixels = shape().pixels();
            const float share = variance / static_cast<float>(shape().planes);
            const auto light = std::as_const(x_).frame(slot);
            for (std::size_t i = 0; i < pixels; ++i) {
                float sum = 0;
                for (std::size_t site = i; site < light.size(); site += pixels) sum += light[site];
                step_[index(slot) * pixels + i] = share * sum + variance * scale_.offset;
            }
        });
        parallel_for(0, static_cast<int>(runs_.size()),
                     [&](int i) { prox_(runs_[index(i)], step_, x_.data()); });
    }

    Measurements& measurements_;
    const SampleNoise& noise_;
    const CollaborativeOptions& options_;
    Denoiser denoiser_;
    AnscombeParams scale_;
    float last_sigma_;
    float first_sigma_;
    FluxVideo& x_;
    std::list<Sensor> sensors_;
    FluxVideo noisy_;
    FluxVideo filtered_;
    FluxVideo pilot_;  ///< the last filtered estimate
    std::vector<SiteRun> runs_;
    std::vector<float> step_;
    JointProx prox_;
    float samples_per_voxel_;
};

CollaborativeOptions options_for(const Measurements& measurements, CollaborativeOptions options) {
    if (!measurements.mosaic) return options;
    options.iterations = options.mosaic.iterations;
    options.first_sigma = options.mosaic.first_sigma;
    return options;
}

constexpr KeyRange kIterations{0, 10000};
constexpr KeyRange kEvery{1, 10000};
constexpr KeyRange kSigma{1e-3, 10};

void read_matching(Config& config, const char* prefix, MatchingOptions& matching) {
    constexpr KeyRange kReach{0, 32};
    const KeyReader read(config, prefix);
    read({"slots", kReach, "slots", "slots searched before and after"}, matching.slots);
    read({"own_radius", kReach, "pixels", "search radius in the slot of the reference"},
         matching.own_radius);
    read({"path_radius", kReach, "pixels", "search radius around the motion path"},
         matching.path_radius);
}

}  // namespace

void read_options(Config& config, CollaborativeOptions& options) {
    const KeyReader read(config);
    read({"iterations", kIterations, "", "iterations of filter and data-consistency step"},
         options.iterations);
    read({"motion_every", kEvery, "iterations", "interval of estimates of motion"},
         options.motion_every);
    read({"match_every", kEvery, "iterations", "interval of searches for similar patches"},
         options.match_every);
    read({"patch_stride", {1, kPatchSide}, "pixels", "stride of reference patches"},
         options.patch_stride);
    read_matching(config, "matching.", options.matching);
    read({"first_sigma", kSigma, "", "sigma of the first iteration, on the scale 2 sqrt(light)"},
         options.first_sigma);
    read({"last_noise", {0, 100}, "", "sigma of the last iteration, in shot noise of one slot"},
         options.last_noise);
    read({"min_sigma", kSigma, "", "smallest sigma of the last iteration"}, options.min_sigma);
    read({"light_offset", {1e-4, 1e3}, "flux", "smallest offset under the square root"},
         options.light_offset);
    read({"min_light", {-10, 0}, "flux", "smallest light; minus the offset at least"},
         options.min_light);
    read({"residual_gain", {0, 2}, "", "share of the residuals that is added to the samples"},
         options.residual_gain);
    read({"residual_decay", {0, 1}, "", "decay of the added residuals in each iteration"},
         options.residual_decay);
    read({"data_step",
          {0.01, 100},
          "",
          "step size of the data-consistency step, times sigma^2 (x + offset)"},
         options.data_step);
    read({"momentum", {0, 1}, "", "momentum beta: x + beta (x - x_previous)"}, options.momentum);
    read({"mosaic.iterations", kIterations, "", "iterations of a mosaic"},
         options.mosaic.iterations);
    read({"mosaic.first_sigma", kSigma, "", "first_sigma of a mosaic"}, options.mosaic.first_sigma);
    read({"mosaic.near_iterations", kIterations, "",
          "first iterations of a mosaic, with patches from nearby"},
         options.mosaic.near_iterations);
    read_matching(config, "mosaic.near.", options.mosaic.near);
    read({"direct.iterations", kIterations, "", "iterations on samples of one slot each"},
         options.direct.iterations);
    read({"direct.match_every", kEvery, "iterations", "match_every and motion_every of these"},
         options.direct.match_every);
    read({"direct.patch_stride", {1, kPatchSide}, "pixels", "patch_stride of these"},
         options.direct.patch_stride);
    read({"direct.data_step", {0.01, 100}, "", "data_step of these"}, options.direct.data_step);
    read({"noise_free.iterations", kIterations, "", "iterations without noise"},
         options.noise_free.iterations);
    read({"noise_free.first_sigma", kSigma, "", "first_sigma without noise"},
         options.noise_free.first_sigma);
    read({"noise_free.min_sigma", kSigma, "", "sigma of the last iteration without noise"},
         options.noise_free.min_sigma);
    read({"noise_free.light_offset", {1e-4, 1e3}, "flux", "light_offset without noise"},
         options.noise_free.light_offset);
}

CollaborativeOptions for_direct_samples(CollaborativeOptions options) {
    options.iterations = options.direct.iterations;
    options.match_every = options.motion_every = options.direct.match_every;
    options.patch_stride = options.direct.patch_stride;
    options.data_step = options.direct.data_step;
    options.first_sigma = 0;  // the last one holds
    return options;
}

CollaborativeOptions without_noise(CollaborativeOptions options) {
    options.iterations = options.noise_free.iterations;
    options.first_sigma = options.noise_free.first_sigma;
    options.last_noise = 0;
    options.min_sigma = options.noise_free.min_sigma;
    options.light_offset = options.noise_free.light_offset;
    options.residual_gain = 1;
    options.residual_decay = 1;
    return options;
}

std::optional<FluxVideo> decode_collaborative(Measurements& measurements, const SampleNoise& noise,
                                              const CollaborativeOptions& options,
                                              const ProgressCallback& progress) {
    return decode_collaborative({measurements, noise, progress}, options);
}

std::optional<FluxVideo> decode_collaborative(const SplittingTask& task,
                                              const CollaborativeOptions& options) {
    const FrameShape shape = task.measurements.shape;
    if (std::min(shape.rows, shape.cols) < kPatchSide) {
        auto x = decode_motion_tv(task.measurements, task.noise, options.start, task.progress);
        if (x && task.start != nullptr) *task.start = *x;
        return x;
    }
    const auto patches = [&](const CollaborativeOptions& of_block, bool mosaic) {
        return PatchDenoiser(of_block, mosaic, task.noise_gain);
    };
    return decode_by_splitting(task, options, patches);
}

std::optional<FluxVideo> decode_by_splitting(const SplittingTask& task,
                                             const CollaborativeOptions& all_options,
                                             const DenoiserMaker& denoiser) {
    const CollaborativeOptions options = options_for(task.measurements, all_options);

    // x0: the result of `fast`.
    auto x = decode_motion_tv(task.measurements, task.noise, options.start, [&](double fraction) {
        return task.progress(kStartShare * fraction);
    });
    if (!x) return x;
    if (task.start != nullptr) *task.start = *x;

    // Denoiser and data consistency in turn, for noise that decreases.
    SplittingSolver solver(task, options, denoiser(options, task.measurements.mosaic), *x);
    bool stopped = false;
    for (int i = 0; i < options.iterations && !stopped; ++i) {
        solver.iterate(i);
        stopped = !task.progress(kStartShare + (1 - kStartShare) * (i + 1) / options.iterations);
    }
    solver.restore_samples();
    if (stopped) return {};
    return x;
}

float samples_per_voxel(const Measurements& measurements) {
    std::ptrdiff_t samples = 0;
    for_each_sensor(measurements, [&](const Measurements& sensor) {
        samples += std::ranges::count_if(
            sensor.state, [](std::uint8_t state) { return (state & Measurements::kLast) != 0; });
    });
    return static_cast<float>(static_cast<double>(samples) /
                              static_cast<double>(measurements.voxels()));
}

}  // namespace stipple
