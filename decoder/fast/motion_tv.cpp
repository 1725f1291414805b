#include "decoder/fast/motion_tv.h"

#include <algorithm>
#include <cstddef>
#include <list>
#include <span>
#include <vector>

#include "core/config.h"
#include "core/index.h"
#include "core/light.h"
#include "core/parallel.h"
#include "decoder/fast/box_blur.h"
#include "decoder/fast/censored_samples.h"
#include "decoder/fast/pseudo_samples.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "decoder/pixel_response.h"
#include "decoder/sampling_operator.h"

namespace stipple {
namespace {

constexpr float kMinStep = 0.05F;  // of the step at `step_flux`
constexpr float kMaxStep = 4;

/// Light of a frame as one plane.
void reduce_to_one_plane(std::span<const float> frame, std::span<float> light) {
    if (frame.size() == 3 * light.size())
        reduce_to_luminance(frame, light);
    else
        std::copy_n(frame.begin(), light.size(), light.begin());
}

/// Primal steps in proportion to the light around a pixel: what is bright is known less exactly,
/// moves further, and differs more from its neighbours.
std::vector<float> primal_steps(const FluxVideo& x, const MotionTvOptions& options) {
    const FrameShape shape = x.shape();
    std::vector<float> step(index(x.slots()) * shape.pixels());
    parallel_for(0, x.slots(), [&](int slot) {
        const auto frame = std::span(step).subspan(index(slot) * shape.pixels(), shape.pixels());
        reduce_to_one_plane(x.frame(slot), frame);
        for (float& s : frame)
            s = options.step * std::clamp(s / options.step_flux, kMinStep, kMaxStep);
        box_blur(shape, frame);
    });
    return step;
}

/// Takes the confidence from links whose partner has a much larger step: it has become brighter,
/// so it is hardly the same thing, and the dual step, made for the smaller one, would not converge.
void cut_links_to_larger_steps(MotionField& field, FrameShape shape, std::span<const float> step,
                               float max_ratio) {
    const auto slots = static_cast<int>(step.size() / shape.pixels());
    const auto cols = index(shape.cols);
    parallel_for(0, slots, [&](int slot) {
        if (slot + field.step < 0 || slot + field.step >= slots) return;
        const float* partner = &step[index(slot + field.step) * shape.pixels()];
        std::size_t i = index(slot) * shape.pixels();
        for (int row = 0; row < shape.rows; ++row)
            for (int col = 0; col < shape.cols; ++col, ++i) {
                const auto partner_pixel = [](int at, int shift, int last) {
                    constexpr int kPerPixel = MotionField::kShiftsPerPixel;
                    return index(std::min((at * kPerPixel + shift) / kPerPixel, last));
                };
                const auto top = partner_pixel(row, field.row_shift[i], shape.rows - 2);
                const auto left = partner_pixel(col, field.col_shift[i], shape.cols - 2);
                const float* at = partner + top * cols + left;
                if (std::max({at[0], at[1], at[cols], at[cols + 1]}) > max_ratio * step[i])
                    field.confidence[i] = 0;
            }
    });
}

/// The first estimate shows no details, and is the least certain; details are worth a close look
/// in the last round only.
MotionOptions motion_options(int round, bool last) {
    if (round == 0) return {.coarse = true, .search = {.range_sigma_px = 0.09F}};
    return last ? MotionOptions{.search = {.patch_stride_px = 5}}
                : MotionOptions{.search = {.patch_stride_px = 6, .range_sigma_px = 0.3F}};
}

/// Counts iterations for the progress. Finding the motion takes about as long as 8 of them.
class WorkCount {
  public:
    WorkCount(const MotionTvOptions& options, const ProgressCallback& progress)
        : total_(options.static_tv.iterations +
                 (options.rounds - 1) * (options.along_motion.iterations + kMotion) +
                 options.last_iterations + kMotion),
          progress_(progress) {}
    void add_motion() { done_ += kMotion; }
    bool add_iteration() {
        ++done_;
        stopped_ = stopped_ || !progress_(static_cast<double>(done_) / total_);
        return !stopped_;
    }
    [[nodiscard]] bool stopped() const { return stopped_; }

  private:
    static constexpr int kMotion = 8;
    int total_;
    int done_ = 0;
    bool stopped_ = false;
    const ProgressCallback& progress_;
};

MotionTvOptions options_for(const Measurements& measurements, MotionTvOptions options) {
    if (!measurements.mosaic) return options;
    options.static_tv.chroma_weight = options.mosaic.chroma_weight;
    options.along_motion.chroma_weight = options.mosaic.chroma_weight;
    options.along_motion.spatial_weight = options.mosaic.spatial_weight;
    options.last_iterations = options.mosaic.last_iterations;
    return options;
}

}  // namespace

void read_options(Config& config, MotionTvOptions& options) {
    constexpr KeyRange kIterations{0, 10000};
    constexpr KeyRange kWeight{0, 1e4};
    const KeyReader read(config);
    read({"static_tv.iterations", kIterations, "", "iterations of the static total variation"},
         options.static_tv.iterations);
    read({"static_tv.spatial_weight", kWeight, "1/flux", "weight of spatial differences"},
         options.static_tv.spatial_weight);
    read({"static_tv.temporal_weight", kWeight, "1/flux", "weight of temporal differences"},
         options.static_tv.temporal_weight);
    read({"along_motion.iterations", kIterations, "", "iterations of each round but the last"},
         options.along_motion.iterations);
    read({"along_motion.spatial_weight", kWeight, "1/flux", "weight of spatial differences"},
         options.along_motion.spatial_weight);
    read({"along_motion.temporal_weight", kWeight, "1/flux",
          "weight of all links of a voxel together"},
         options.along_motion.temporal_weight);
    read({"rounds", {0, 100}, "", "rounds of variances, motion, total variation along it"},
         options.rounds);
    read({"last_iterations", kIterations, "", "iterations of the last round"},
         options.last_iterations);
    read({"mosaic.spatial_weight", kWeight, "1/flux", "along_motion.spatial_weight of a mosaic"},
         options.mosaic.spatial_weight);
    read({"mosaic.chroma_weight", kWeight, "",
          "weight of opponent colours of a mosaic, times the others"},
         options.mosaic.chroma_weight);
    read({"mosaic.last_iterations", kIterations, "", "last_iterations of a mosaic"},
         options.mosaic.last_iterations);
    read({"step", {1e-6, 1}, "flux^2", "primal step at step_flux"}, options.step);
    read({"step_flux", {1e-4, 1e4}, "flux", "light at which the primal step is step"},
         options.step_flux);
    read({"max_step_ratio", {1, 1e4}, "", "largest ratio of the primal steps of linked pixels"},
         options.max_step_ratio);
}

std::optional<FluxVideo> decode_motion_tv(Measurements& measurements, const SampleNoise& noise,
                                          const MotionTvOptions& all_options,
                                          const ProgressCallback& progress) {
    const MotionTvOptions options = options_for(measurements, all_options);
    WorkCount work(options, progress);

    // x0: each voxel has the light of the nearest samples of its pixel.
    FluxVideo x = nearest_samples(measurements);

    // Voxels that no sample holds get a weak one, saturated samples the light expected above them.
    const PseudoSamples pseudo_samples(measurements, x, noise);
    std::list<CensoredSamples> censored;
    for_each_sensor(measurements,
                    [&](Measurements& sensor) { censored.emplace_back(sensor, noise); });

    // min over x >= 0 of  sum (y - Ax)^2 / (2 var y) + weight |grad x|,  by steps tau(x).
    TotalVariationSolver solver(measurements);
    const auto minimise = [&](std::span<const MotionField> motion, std::span<const float> step,
                              TotalVariationOptions tv) {
        tv.reference_step = options.step;
        tv.keep_going = [&] { return work.add_iteration(); };
        solver.minimise(motion, step, tv, x);
    };

    // Without motion: temporal differences stay in their pixel.
    minimise({}, primal_steps(x, options), options.static_tv);

    const FrameShape shape = x.shape();
    const bool can_move = std::min(shape.rows, shape.cols) >= kMinMotionSide;
    for (int round = 0; can_move && round < options.rounds && !work.stopped(); ++round) {
        // var y = read noise^2 + shot noise of Ax, and E[y | y saturated, Ax].
        refresh_variances(measurements, noise, x.data());
        for (CensoredSamples& samples : censored) samples.expect(x.data());

        // Links from each voxel to where its light is in the slots before and after.
        const bool last = round + 1 == options.rounds;
        auto motion = estimate_motion(x, motion_options(round, last));
        work.add_motion();
        const auto step = primal_steps(x, options);
        for (MotionField& field : motion)
            cut_links_to_larger_steps(field, shape, step, options.max_step_ratio);

        // The same problem, with temporal differences along these links.
        auto along_motion = options.along_motion;
        if (last) along_motion.iterations = options.last_iterations;
        minimise(motion, step, along_motion);
    }
    if (work.stopped()) return {};
    return x;
}

}  // namespace stipple
