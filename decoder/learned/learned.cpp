#include "decoder/learned/learned.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/fast/box_blur.h"
#include "decoder/learned/refinement_inputs.h"
#include "decoder/learned/refinement_network.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"
#include "decoder/sampling_operator.h"

namespace stipple {
namespace {

constexpr double kFastShare = 0.5;  // of all work; for the progress
constexpr double kBestShare = 0.85;
constexpr float kMaxSigmas = 5;
constexpr float kTrustedGain = 110;   // coefficients of a patch, of 576
constexpr float kFirstExcess = 0.5F;  // of squared residuals: all of the refinement
constexpr float kLastExcess = 0.8F;   // none of it
constexpr float kMaxSquare = 1e6F;    // of a residual over its noise, which may be nothing
constexpr std::size_t kDarkInput = 14;
constexpr float kMinDark = 0.009F;  // noise of 0.45 electrons, the least in training
constexpr float kMaxDark = 1.25F;   // of 62 electrons, the most
constexpr float kMaxValue = 1e9F;   // its square, light, is far from the largest float

/// \throws InputError as decode_learned, before any work.
void check(const Refiner& refine) {
    if (!refine)
        throw InputError("decoding method", "learned and learned_fast need a file of weights, " +
                                                Parameter{"decoder.model", "FILE.safetensors"});
}

/// Where a sample contradicts the refined light more than the estimate, its voxels keep the
/// estimate: by five standard deviations of its noise, a saturated one at once.
void keep_contradicted(const Measurements& m, const FluxVideo& estimate, FluxVideo& refined) {
    std::vector<float> before(m.voxels()), after(m.voxels());
    sample(m, estimate.data(), before);
    sample(m, refined.data(), after);
    const auto is_contradicted = [&](std::size_t i) {
        const bool saturated = (m.state[i] & Measurements::kSaturated) != 0;
        const float lack = m.sum[i] - after[i], lack_before = m.sum[i] - before[i];
        if (saturated) return lack > 0 && lack > lack_before;
        return std::abs(lack) > kMaxSigmas * std::sqrt(m.variance[i]) &&
               std::abs(lack) > std::abs(lack_before);
    };
    for (std::size_t i = 0; i < m.voxels(); ++i)
        after[i] = (m.state[i] & Measurements::kLast) != 0 && is_contradicted(i) ? 1.0F : 0.0F;
    spread(m, after, after);
    for (std::size_t i = 0; i < m.voxels(); ++i)
        if (after[i] > 0) refined.data()[i] = estimate.data()[i];
}

/// In all voxels of a sample 1, of a saturated one and without any 0.
std::vector<float> exact_samples(const Measurements& m) {
    std::vector<float> known(m.voxels());
    std::ranges::transform(m.state, known.begin(), [](std::uint8_t state) {
        return (state & (Measurements::kLast | Measurements::kSaturated)) == Measurements::kLast
                   ? 1.0F
                   : 0.0F;
    });
    spread(m, known, known);
    return known;
}

/// In all voxels of such a sample its squared residual in the estimate x, over its variance.
std::vector<float> squared_residuals(const Measurements& m, const FluxVideo& x) {
    std::vector<float> squares(m.voxels());
    sample(m, x.data(), squares);
    for (std::size_t i = 0; i < m.voxels(); ++i) {
        const float lack = m.sum[i] - squares[i];
        // In this order the minimum is a number even if the quotient is none.
        squares[i] = (m.state[i] & Measurements::kSaturated) == 0
                         ? std::min(kMaxSquare, lack * lack / m.variance[i])
                         : 0;
    }
    spread(m, squares, squares);
    return squares;
}

/// Where the filter of `best` has averaged so much that its estimate can be trusted, and the
/// refined light explains the samples around it less well than their noise allows, and less well
/// than the estimate does, the light returns to the estimate: still texture that the network does
/// not know.
void keep_unexplained(const Measurements& m, const RefinementInputs::Estimates& estimates,
                      FluxVideo& refined) {
    std::vector<float> known = exact_samples(m);
    std::vector<float> before = squared_residuals(m, estimates.estimate);
    std::vector<float> after = squared_residuals(m, refined);
    const auto estimate = estimates.estimate.data();
    const auto gain = estimates.noise_gain->data();
    const std::size_t pixels = m.shape.pixels();
    parallel_for(0, m.slots * m.shape.planes, [&](int plane) {
        const std::size_t begin = index(plane) * pixels;
        for (auto* values : {&known, &before, &after})
            for (int twice = 0; twice < 2; ++twice)  // about a hundred samples
                box_blur(m.shape, std::span(*values).subspan(begin, pixels));
        for (std::size_t i = begin; i < begin + pixels; ++i) {
            if (gain[i] > kTrustedGain || known[i] <= 0) continue;
            const float ratio = after[i] / std::max(before[i], known[i]);
            const float excess = (ratio - 1) * std::sqrt(known[i]);
            const float back = (excess - kFirstExcess) / (kLastExcess - kFirstExcess);
            refined.data()[i] += std::clamp(back, 0.0F, 1.0F) * (estimate[i] - refined.data()[i]);
        }
    });
}

/// False if `progress` has stopped it.
bool refine_estimate(const SplittingTask& task, const RefinementInputs::Estimates& estimates,
                     const Refiner& refine, const ProgressCallback& progress, FluxVideo& x) {
    const RefinementInputs inputs(task.measurements, task.noise, estimates);
    const FrameShape shape = x.shape();
    std::vector<float> seen(kRefinementInputs * shape.pixels());
    std::vector<float> refined(shape.pixels());
    FluxVideo result(x.slots(), shape);
    for (int slot = 0; slot < x.slots(); ++slot) {
        for (int plane = 0; plane < shape.planes; ++plane) {
            inputs.write(slot, plane, seen);
            refine({seen, shape.rows, shape.cols}, refined);
            if (!std::ranges::all_of(refined, [](float v) { return std::abs(v) <= kMaxValue; }))
                throw InputError("refiner", fmt::format("its result has a value in slot {} of the "
                                                        "block that is not finite, or above 1e9",
                                                        slot));
            inputs.restore(
                slot, plane, refined,
                result.frame(slot).subspan(index(plane) * shape.pixels(), shape.pixels()));
        }
        if (!progress(static_cast<double>(slot + 1) / x.slots())) return false;
    }
    keep_contradicted(task.measurements, x, result);
    if (!task.noise.none() && estimates.knows_noise_gain())
        keep_unexplained(task.measurements, estimates, result);
    x = std::move(result);
    return true;
}

/// Parts of one progress.
ProgressCallback part(const ProgressCallback& whole, double begin, double end) {
    return [&whole, begin, end](double done) { return whole(begin + (end - begin) * done); };
}

}  // namespace

void read_options(Config& config, LearnedOptions& options) {
    const KeyReader read(config);
    read({.name = "model", .text = "safetensors file of other weights of the network"},
         options.model_file);
}

Refiner refinement_of(const std::string& file) {
    const auto network = std::make_shared<const RefinementNetwork>(RefinementNetwork::read(file));
    const auto& metadata = network->metadata();
    const auto inputs = metadata.find("inputs");
    if (network->inputs() != kRefinementInputs || inputs == metadata.end() ||
        inputs->second != kRefinementInputsName)
        throw InputError(
            file, fmt::format("its network has {} inputs of version \"{}\", but this program gives "
                              "{} of version \"{}\"",
                              network->inputs(), inputs == metadata.end() ? "" : inputs->second,
                              kRefinementInputs, kRefinementInputsName));
    return [network](const RefinerInput& input, std::span<float> refined) {
        const float dark = input.inputs[kDarkInput * refined.size()];
        const bool without_noise = dark < 0;
        if (!without_noise && (dark < kMinDark || dark > kMaxDark)) {
            std::ranges::copy(input.inputs.first(refined.size()), refined.begin());
            return;
        }
        network->refine(input.inputs, input.rows, input.cols, refined);
    };
}

std::optional<FluxVideo> decode_learned(const SplittingTask& task,
                                        const CollaborativeOptions& options,
                                        const Refiner& refine) {
    check(refine);
    FluxVideo start, noise_gain;
    auto x = decode_collaborative(
        {task.measurements, task.noise, part(task.progress, 0, kBestShare), &start, &noise_gain},
        options);
    if (!x) return {};
    const RefinementInputs::Estimates estimates{*x, start, &noise_gain};
    if (!refine_estimate(task, estimates, refine, part(task.progress, kBestShare, 1), *x))
        return {};
    return x;
}

std::optional<FluxVideo> decode_learned_fast(const SplittingTask& task,
                                             const MotionTvOptions& options,
                                             const Refiner& refine) {
    check(refine);
    auto x = decode_motion_tv(task.measurements, task.noise, options,
                              part(task.progress, 0, kFastShare));
    if (!x) return {};
    if (!refine_estimate(task, {*x, *x}, refine, part(task.progress, kFastShare, 1), *x)) return {};
    return x;
}

}  // namespace stipple
