// Compiled once per SIMD target by foreach_target.h, chosen at run time. The loops over sites are
// left to the compiler's vectoriser; every target gives the same bits.
#include "decoder/data_prox.h"
#include "decoder/measurements.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decoder/data_prox.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include <algorithm>
#include <cassert>
#include <cstdint>

#include "decoder/exposure_chains-inl.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {

/// One slot of a run.
struct Slice {
    std::size_t sites;
    const std::uint8_t* state;
    const float* y;
    const float* variance;
    const float* step;
    const float* weight;  ///< null without weights
    float* v;
    float* dual;  ///< null without
};

/// Arrays that the map reads and writes.
struct Arrays {
    const float* step;
    float* v;
    float* dual;
};

template <bool kWeighted, bool kDual>
Slice slice(const Measurements& m, const SiteRun& run, std::size_t slot, const Arrays& arrays) {
    const std::size_t voxel = slot * m.shape.sites() + run.begin;
    const std::size_t pixels = m.shape.pixels();
    return {.sites = run.end - run.begin,
            .state = &m.state[voxel],
            .y = &m.sum[voxel],
            .variance = &m.variance[voxel],
            .step = arrays.step + slot * pixels + run.begin % pixels,
            .weight = kWeighted ? &m.weight[voxel] : nullptr,
            .v = arrays.v + voxel,
            .dual = kDual ? arrays.dual + voxel : nullptr};
}

/// Adds a slot to the sums of w v and w^2 step over each exposure, w the weight of a voxel;
/// `correction` is (y - sum w v) / (variance + sum w^2 step) where an exposure ends, else anything.
/// With duals v has the part of the last one, which is taken out first: `correction` is the
/// increase of the dual.
template <Chain kChain, bool kWeighted, bool kDual, bool kZeroIsBound>
void add_up(const Slice& s, float* HWY_RESTRICT sum_v, float* HWY_RESTRICT sum_step,
            float* HWY_RESTRICT correction) {
    const std::uint8_t* HWY_RESTRICT states = s.state;
    for (std::size_t i = 0; i < s.sites; ++i) {
        const std::uint8_t state = state_in<kChain>(states[i]);
        const float keep = (state & Measurements::kFirst) != 0 ? 0.0F : 1.0F;
        const float weight = kWeighted ? s.weight[i] : 1.0F;
        const float open = (state & Measurements::kOpen) != 0 ? weight : 0.0F;
        sum_v[i] = keep * sum_v[i] + open * s.v[i];
        sum_step[i] = keep * sum_step[i] + (kWeighted ? open * weight : open) * s.step[i];
        const float before = kDual ? s.dual[i] : 0.0F;
        const float missing = kDual ? s.y[i] - sum_v[i] + before * sum_step[i] : s.y[i] - sum_v[i];
        const bool explained = ((state & Measurements::kSaturated) != 0 && missing < 0) ||
                               (kZeroIsBound && (state & Measurements::kZero) != 0 && missing > 0);
        const float dual = explained ? 0.0F : missing / (s.variance[i] + sum_step[i]);
        correction[i] = kDual ? dual - before : dual;
        if (kDual) s.dual[i] = (state & Measurements::kLast) != 0 ? dual : before;
    }
}

/// Moves the open voxels of a slot; `correction` is that of the exposure each is in.
template <Chain kChain, bool kWeighted>
void distribute(const Slice& s, const float* HWY_RESTRICT ending, float* HWY_RESTRICT correction) {
    const std::uint8_t* HWY_RESTRICT states = s.state;
    float* HWY_RESTRICT v = s.v;
    for (std::size_t i = 0; i < s.sites; ++i) {
        const std::uint8_t state = state_in<kChain>(states[i]);
        correction[i] = (state & Measurements::kLast) != 0 ? ending[i] : correction[i];
        const float step = kWeighted ? s.weight[i] * s.step[i] : s.step[i];
        const float move = step * correction[i];
        v[i] += (state & Measurements::kOpen) != 0 ? move : 0.0F;
    }
}

template <Chain kChain, bool kWeighted, bool kDual, bool kZeroIsBound = false>
void prox_chain(const Measurements& m, const SiteRun& run, const Arrays& arrays) {
    const auto slots = static_cast<std::size_t>(m.slots);
    // 128 KB, of which each slot uses a row: to zero all would take longer than the sums.
    __attribute__((uninitialized)) float ending[kMaxRunSlots][kMaxRunSites];
    float sum_v[kMaxRunSites] = {};
    float sum_step[kMaxRunSites] = {};
    for (std::size_t slot = 0; slot < slots; ++slot)
        add_up<kChain, kWeighted, kDual, kZeroIsBound>(
            slice<kWeighted, kDual>(m, run, slot, arrays), sum_v, sum_step, ending[slot]);
    float correction[kMaxRunSites] = {};
    for (std::size_t slot = slots; slot-- > 0;)
        distribute<kChain, kWeighted>(slice<kWeighted, kDual>(m, run, slot, arrays), ending[slot],
                                      correction);
}

/// v + step A^T dual.
template <Chain kChain, bool kWeighted>
void add_duals(const Measurements& m, const SiteRun& run, const Arrays& arrays) {
    float correction[kMaxRunSites] = {};
    for (auto slot = static_cast<std::size_t>(m.slots); slot-- > 0;) {
        const Slice s = slice<kWeighted, true>(m, run, slot, arrays);
        distribute<kChain, kWeighted>(s, s.dual, correction);
    }
}

void prox_run(const Measurements& m, const SiteRun& run, const float* step, float* v) {
    for_each_chain(m, [&](auto chain, auto weighted) {
        if (m.zero_is_bound)
            prox_chain<chain(), weighted(), false, true>(m, run, {step, v, nullptr});
        else
            prox_chain<chain(), weighted(), false>(m, run, {step, v, nullptr});
    });
}

void prox_dual_run(const Measurements& m, const SiteRun& run, const float* step, float* v,
                   float* dual) {
    for_each_chain(m, [&](auto chain, auto weighted) {
        prox_chain<chain(), weighted(), true>(m, run, {step, v, dual});
    });
}

void add_dual_run(const Measurements& m, const SiteRun& run, const float* step, float* v,
                  float* dual) {
    for_each_chain(m, [&](auto chain, auto weighted) {
        add_duals<chain(), weighted()>(m, run, {step, v, dual});
    });
}

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stipple {

HWY_EXPORT(prox_run);
HWY_EXPORT(prox_dual_run);
HWY_EXPORT(add_dual_run);

std::vector<SiteRun> site_runs(FrameShape shape) {
    std::vector<SiteRun> runs;
    for (std::size_t plane = 0; plane < shape.sites(); plane += shape.pixels())
        for (std::size_t begin = 0; begin < shape.pixels(); begin += kMaxRunSites)
            runs.push_back({.begin = plane + begin,
                            .end = plane + std::min(begin + kMaxRunSites, shape.pixels())});
    return runs;
}

void data_prox(const Measurements& measurements, const SiteRun& run, std::span<const float> step,
               std::span<float> v) noexcept {
    assert(run.end - run.begin <= kMaxRunSites && measurements.slots <= kMaxRunSlots);
    assert(v.size() == measurements.voxels());
    HWY_DYNAMIC_DISPATCH(prox_run)(measurements, run, step.data(), v.data());
}

void data_prox(const Measurements& measurements, const SiteRun& run, std::span<const float> step,
               const DualVideo& x) noexcept {
    assert(run.end - run.begin <= kMaxRunSites && measurements.slots <= kMaxRunSlots);
    assert(x.v.size() == measurements.voxels() && x.dual.size() == measurements.voxels());
    HWY_DYNAMIC_DISPATCH(prox_dual_run)
    (measurements, run, step.data(), x.v.data(), x.dual.data());
}

void add_duals(const Measurements& measurements, const SiteRun& run, std::span<const float> step,
               const DualVideo& x) noexcept {
    HWY_DYNAMIC_DISPATCH(add_dual_run)
    (measurements, run, step.data(), x.v.data(), x.dual.data());
}

}  // namespace stipple
#endif  // HWY_ONCE
