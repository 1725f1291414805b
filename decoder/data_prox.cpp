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
};

template <bool kWeighted>
Slice slice(const Measurements& m, const SiteRun& run, std::size_t slot, const float* step,
            float* v) {
    const std::size_t voxel = slot * m.shape.sites() + run.begin;
    const std::size_t pixels = m.shape.pixels();
    return {.sites = run.end - run.begin,
            .state = &m.state[voxel],
            .y = &m.sum[voxel],
            .variance = &m.variance[voxel],
            .step = step + slot * pixels + run.begin % pixels,
            .weight = kWeighted ? &m.weight[voxel] : nullptr,
            .v = v + voxel};
}

/// The chains of exposures that are looked at; the voxels of others count as unobserved.
enum class Chain : std::uint8_t { kOnly, kFirst, kSecond };

template <Chain kChain>
std::uint8_t state_in(std::uint8_t state) {
    if (kChain == Chain::kOnly) return state;
    const bool second = (state & Measurements::kSecond) != 0;
    return second == (kChain == Chain::kSecond) ? state : 0;
}

/// Adds a slot to the sums of w v and w^2 step over each exposure, w the weight of a voxel;
/// `correction` is (y - sum w v) / (variance + sum w^2 step) where an exposure ends, else anything.
template <Chain kChain, bool kWeighted>
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
        const float missing = s.y[i] - sum_v[i];
        const bool explained = (state & Measurements::kSaturated) != 0 && missing < 0;
        correction[i] = explained ? 0.0F : missing / (s.variance[i] + sum_step[i]);
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

template <Chain kChain, bool kWeighted>
void prox_chain(const Measurements& m, const SiteRun& run, const float* step, float* v) {
    const auto slots = static_cast<std::size_t>(m.slots);
    // 128 KB, of which each slot uses a row: to zero all would take longer than the sums.
    __attribute__((uninitialized)) float ending[kMaxRunSlots][kMaxRunSites];
    float sum_v[kMaxRunSites] = {};
    float sum_step[kMaxRunSites] = {};
    for (std::size_t slot = 0; slot < slots; ++slot)
        add_up<kChain, kWeighted>(slice<kWeighted>(m, run, slot, step, v), sum_v, sum_step,
                                  ending[slot]);
    float correction[kMaxRunSites] = {};
    for (std::size_t slot = slots; slot-- > 0;)
        distribute<kChain, kWeighted>(slice<kWeighted>(m, run, slot, step, v), ending[slot],
                                      correction);
}

/// Chains share no voxel, so one after the other is both at once.
template <bool kWeighted>
void prox_chains(const Measurements& m, const SiteRun& run, const float* step, float* v) {
    if (!m.interleaved) return prox_chain<Chain::kOnly, kWeighted>(m, run, step, v);
    prox_chain<Chain::kFirst, kWeighted>(m, run, step, v);
    prox_chain<Chain::kSecond, kWeighted>(m, run, step, v);
}

void prox_run(const Measurements& m, const SiteRun& run, const float* step, float* v) {
    m.weight.empty() ? prox_chains<false>(m, run, step, v) : prox_chains<true>(m, run, step, v);
}

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stipple {

HWY_EXPORT(prox_run);

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

}  // namespace stipple
#endif  // HWY_ONCE
