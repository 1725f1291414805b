// Compiled once per SIMD target by foreach_target.h, chosen at run time. The loops over sites are
// left to the compiler's vectoriser; every target gives the same bits.
#include "decoder/live/exposure_kernels.h"

#include "decoder/measurements.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decoder/live/exposure_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "decoder/exposure_chains-inl.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {
namespace {

constexpr float kLongMemory = 0.939413063F;   // exp(-1 / 16)
constexpr float kShortMemory = 0.513417119F;  // exp(-1 / 1.5)
constexpr float kFullMemoryFraction = 0.8F;   // of slots in exposures that are not saturated
constexpr float kMotionOfSlot = 0.11F;        // change of the mean light from slot to slot
constexpr float kMinLight = 0.03F;            // of that change
constexpr float kRestoredNoise = 3;           // variances of a sample
constexpr float kDarkStep = 1e-3F;            // step size without light
constexpr float kTiny = 1e-9F;                // keeps a variance from being 0

/// One number for each slot of a window and site of a run.
using RunFloats = float[LiveWindow::kMaxSlots][kMaxRunSites];

/// One slot of a run.
struct Slice {
    std::size_t sites;
    const std::uint8_t* state;
    const float* y;
    const float* variance;
    const float* weight;  ///< null without weights
};

template <bool kWeighted>
Slice slice(const WindowRun& run, int slot) {
    const Measurements& m = run.measurements;
    const std::size_t voxel = static_cast<std::size_t>(slot) * m.shape.sites() + run.sites.begin;
    return {.sites = run.sites.end - run.sites.begin,
            .state = &m.state[voxel],
            .y = &m.sum[voxel],
            .variance = &m.variance[voxel],
            .weight = kWeighted ? &m.weight[voxel] : nullptr};
}

/// Where the arrays of a window have a slot of the block.
std::size_t window_voxel(const WindowRun& run, int slot) {
    return static_cast<std::size_t>(slot - run.window.begin) * run.measurements.shape.sites() +
           run.sites.begin;
}

/// What is known of an exposure under way at each site.
struct Progress {
    float begun[kMaxRunSites] = {};  ///< 1: its first voxel is in the window
    float length[kMaxRunSites] = {};
    float light[kMaxRunSites] = {};  ///< sum of w x
    float step[kMaxRunSites] = {};   ///< sum of w^2 s, s the step size
};

/// Samples of a window, of the exposures that end in a slot; 0 where none does.
struct RunSamples {
    RunFloats length;  ///< of those that are not saturated
    RunFloats light;   ///< the same
    float exposed[kMaxRunSites];
    float usable[kMaxRunSites];  ///< sum of `length`
    float bound[kMaxRunSites];   ///< highest light per slot of saturated exposures
};

template <Chain kChain, bool kWeighted>
void gather(const Slice& s, Progress& progress, std::size_t t, RunSamples& samples) {
    float* HWY_RESTRICT begun = progress.begun;
    float* HWY_RESTRICT length = progress.length;
    float* HWY_RESTRICT lengths = samples.length[t];
    float* HWY_RESTRICT lights = samples.light[t];
    for (std::size_t i = 0; i < s.sites; ++i) {
        const std::uint8_t state = state_in<kChain>(s.state[i]);
        const bool first = (state & Measurements::kFirst) != 0;
        const float open = (state & Measurements::kOpen) != 0 ? 1.0F : 0.0F;
        begun[i] = first ? 1.0F : begun[i];
        length[i] = (first ? 0.0F : length[i]) + (kWeighted ? open * s.weight[i] : open);
        const float ended = (state & Measurements::kLast) != 0 ? begun[i] : 0.0F;
        const float usable = (state & Measurements::kSaturated) != 0 ? 0.0F : ended;
        lengths[i] += usable * length[i];
        lights[i] += usable * s.y[i];
        samples.exposed[i] += ended * length[i];
        samples.usable[i] += usable * length[i];
        const float bound = (ended - usable) * s.y[i] / std::max(length[i], kTiny);
        samples.bound[i] = std::max(samples.bound[i], bound);
    }
}

/// The weighted mean at each slot, of exposures that have ended there or earlier, and of later
/// ones. `light` are the sites of the first slot; those of the next one are `stride` further.
void average_samples(const RunSamples& samples, int slot_count, std::size_t stride,
                     std::span<float> light) {
    const auto slots = static_cast<std::size_t>(slot_count);
    const std::size_t sites = light.size();
    float memory[kMaxRunSites], sum[kMaxRunSites] = {}, weight[kMaxRunSites] = {};
    for (std::size_t i = 0; i < sites; ++i) {
        const float fraction =
            samples.usable[i] / std::max(kFullMemoryFraction * samples.exposed[i], kTiny);
        memory[i] = kShortMemory + (kLongMemory - kShortMemory) * std::min(fraction, 1.0F);
    }
    __attribute__((uninitialized)) RunFloats earlier_sum, earlier_weight;
    for (std::size_t t = 0; t < slots; ++t)
        for (std::size_t i = 0; i < sites; ++i) {
            sum[i] = earlier_sum[t][i] = memory[i] * sum[i] + samples.light[t][i];
            weight[i] = earlier_weight[t][i] = memory[i] * weight[i] + samples.length[t][i];
        }
    for (std::size_t i = 0; i < sites; ++i) sum[i] = weight[i] = 0;
    for (std::size_t t = slots; t-- > 0;) {
        float* HWY_RESTRICT x = light.data() + t * stride;
        for (std::size_t i = 0; i < sites; ++i) {
            const float all = weight[i] + earlier_weight[t][i];
            const float mean = (sum[i] + earlier_sum[t][i]) / std::max(all, kTiny);
            x[i] = std::max(all > 0 ? mean : samples.bound[i], 0.0F);
            sum[i] = memory[i] * (sum[i] + samples.light[t][i]);
            weight[i] = memory[i] * (weight[i] + samples.length[t][i]);
        }
    }
}

/// Adds a slot to the sums over each exposure. `precision` and `weighted` are those of the exposure
/// where one ends, else anything.
template <Chain kChain, bool kWeighted>
void add_up(const Slice& s, const float* HWY_RESTRICT x, Progress& progress,
            float* HWY_RESTRICT precision, float* HWY_RESTRICT weighted) {
    for (std::size_t i = 0; i < s.sites; ++i) {
        const std::uint8_t state = state_in<kChain>(s.state[i]);
        const bool first = (state & Measurements::kFirst) != 0;
        const float is_open = (state & Measurements::kOpen) != 0 ? 1.0F : 0.0F;
        const float open = kWeighted ? is_open * s.weight[i] : is_open;
        const float length = (first ? 0.0F : progress.length[i]) + open;
        const float light = (first ? 0.0F : progress.light[i]) + open * x[i];
        const float begun = first ? 1.0F : progress.begun[i];
        const float inverse = 1 / std::max(length, kTiny);
        const float residual = (s.y[i] - light) * inverse;
        const float motion =
            kMotionOfSlot * std::max(light * inverse, kMinLight) * std::max(length - 1, 0.0F);
        const float variance = s.variance[i] * inverse * inverse + motion * motion;
        const bool explained = (state & Measurements::kSaturated) != 0 && residual < 0;
        precision[i] = explained ? 0.0F : begun / (variance + kTiny);
        weighted[i] = precision[i] * residual;
        progress.length[i] = length;
        progress.light[i] = light;
        progress.begun[i] = begun;
    }
}

/// Numbers of the exposures that end in a slot, and of that to which each site's next slot belongs.
struct Spread {
    const float* HWY_RESTRICT ending;
    float* HWY_RESTRICT current;
};

/// Sets `to` to the numbers of the exposures that are open in a slot, or else to 0; or adds them.
template <Chain kChain, bool kAdd>
void spread(const Slice& s, const Spread& from, float* HWY_RESTRICT to) {
    for (std::size_t i = 0; i < s.sites; ++i) {
        const std::uint8_t state = state_in<kChain>(s.state[i]);
        from.current[i] = (state & Measurements::kLast) != 0 ? from.ending[i] : from.current[i];
        const float here = (state & Measurements::kOpen) != 0 ? from.current[i] : 0.0F;
        to[i] = kAdd ? to[i] + here : here;
    }
}

template <Chain kChain, bool kWeighted>
void spread_chain(const WindowRun& run, const WindowSlots& slots, const float* light,
                  const SpreadResiduals& residuals) {
    constexpr bool kAdd = kChain == Chain::kSecond;
    __attribute__((uninitialized)) RunFloats end_precision, end_weighted;
    Progress progress;
    for (int slot = run.window.begin; slot < run.window.end; ++slot) {
        const int t = slot - run.window.begin;
        add_up<kChain, kWeighted>(slice<kWeighted>(run, slot), light + window_voxel(run, slot),
                                  progress, end_precision[t], end_weighted[t]);
    }
    float precision[kMaxRunSites] = {}, weighted[kMaxRunSites] = {}, unused[kMaxRunSites] = {};
    for (int slot = run.window.end; slot-- > slots.begin;) {
        const int t = slot - run.window.begin;
        const Slice s = slice<kWeighted>(run, slot);
        const std::size_t voxel = window_voxel(run, slot);
        const bool wanted = slot < slots.end;
        spread<kChain, kAdd>(s, {end_precision[t], precision},
                             wanted ? &residuals.precision[voxel] : unused);
        spread<kChain, kAdd>(s, {end_weighted[t], weighted},
                             wanted ? &residuals.weighted[voxel] : unused);
    }
}

float step_of(float light) {
    return std::max(light, 0.0F) + kDarkStep;
}

/// Adds a slot to the sums over each exposure: `move` is g r / sum w^2 s where an exposure ends.
template <Chain kChain, bool kWeighted>
void add_up_steps(const Slice& s, const float* HWY_RESTRICT x, Progress& progress,
                  float* HWY_RESTRICT move) {
    for (std::size_t i = 0; i < s.sites; ++i) {
        const std::uint8_t state = state_in<kChain>(s.state[i]);
        const bool first = (state & Measurements::kFirst) != 0;
        const float is_open = (state & Measurements::kOpen) != 0 ? 1.0F : 0.0F;
        const float open = kWeighted ? is_open * s.weight[i] : is_open;
        const float begun = first ? 1.0F : progress.begun[i];
        const float light = (first ? 0.0F : progress.light[i]) + open * x[i];
        const float step = (first ? 0.0F : progress.step[i]) +
                           (kWeighted ? open * s.weight[i] : open) * step_of(x[i]);
        const float r = s.y[i] - light;
        const float gain = begun * r * r / (r * r + kRestoredNoise * s.variance[i] + kTiny);
        const bool explained = (state & Measurements::kSaturated) != 0 && r < 0;
        move[i] = explained ? 0.0F : gain * r / std::max(step, kDarkStep);
        progress.light[i] = light;
        progress.step[i] = step;
        progress.begun[i] = begun;
    }
}

template <Chain kChain, bool kWeighted>
void restore_chain(const WindowRun& run, const float* light, float* result) {
    const LiveWindow& window = run.window;
    __attribute__((uninitialized)) RunFloats ending;
    Progress progress;
    for (int slot = window.begin; slot < window.end; ++slot)
        add_up_steps<kChain, kWeighted>(slice<kWeighted>(run, slot),
                                        light + window_voxel(run, slot), progress,
                                        ending[slot - window.begin]);
    float current[kMaxRunSites] = {}, moves[kMaxRunSites] = {};
    for (int slot = window.end; slot-- > window.core_begin;) {
        const Slice s = slice<kWeighted>(run, slot);
        spread<kChain, false>(s, {ending[slot - window.begin], current}, moves);
        if (slot >= window.core_end) continue;
        const float* HWY_RESTRICT x = light + window_voxel(run, slot);
        float* HWY_RESTRICT to =
            result +
            static_cast<std::size_t>(slot - window.core_begin) * run.measurements.shape.sites() +
            run.sites.begin;
        for (std::size_t i = 0; i < s.sites; ++i) {
            const float step = kWeighted ? s.weight[i] * step_of(x[i]) : step_of(x[i]);
            to[i] = (kChain == Chain::kSecond ? to[i] : x[i]) + step * moves[i];
        }
    }
}

}  // namespace

void average_run(const WindowRun& run, float* light, std::uint8_t* known) {
    const LiveWindow& window = run.window;
    const SiteRun& range = run.sites;
    RunSamples samples = {};
    for_each_chain(run.measurements, [&](auto chain, auto weighted) {
        Progress progress;
        for (int slot = window.begin; slot < window.end; ++slot)
            gather<chain(), weighted()>(slice<weighted()>(run, slot), progress,
                                        static_cast<std::size_t>(slot - window.begin), samples);
    });
    average_samples(samples, window.slots(), run.measurements.shape.sites(),
                    {light + range.begin, light + range.end});
    for (std::size_t i = range.begin; i < range.end; ++i) {
        const std::size_t site = i - range.begin;
        known[i] = samples.usable[site] > 0 ? 2 : samples.exposed[site] > 0 ? 1 : 0;
    }
}

void spread_run(const WindowRun& run, const WindowSlots& slots, const float* light,
                const SpreadResiduals& residuals) {
    for_each_chain(run.measurements, [&](auto chain, auto weighted) {
        spread_chain<chain(), weighted()>(run, slots, light, residuals);
    });
}

void restore_run(const WindowRun& run, const float* light, float* result) {
    for_each_chain(run.measurements, [&](auto chain, auto weighted) {
        restore_chain<chain(), weighted()>(run, light, result);
    });
}

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stipple {

HWY_EXPORT(average_run);
HWY_EXPORT(spread_run);
HWY_EXPORT(restore_run);

void average_in_time(const WindowRun& run, std::span<float> light,
                     std::span<std::uint8_t> known) noexcept {
    assert(run.window.slots() <= LiveWindow::kMaxSlots);
    HWY_DYNAMIC_DISPATCH(average_run)(run, light.data(), known.data());
}

void spread_residuals(const WindowRun& run, const WindowSlots& slots, std::span<const float> light,
                      const SpreadResiduals& residuals) noexcept {
    assert(run.window.begin <= slots.begin && slots.end <= run.window.end);
    HWY_DYNAMIC_DISPATCH(spread_run)(run, slots, light.data(), residuals);
}

void restore_sums(const WindowRun& run, std::span<const float> light,
                  std::span<float> result) noexcept {
    HWY_DYNAMIC_DISPATCH(restore_run)(run, light.data(), result.data());
}

}  // namespace stipple
#endif  // HWY_ONCE
