// The chains of exposures of a measurement; included once per SIMD target (Highway), so without
// #pragma once.
#if defined(STIPPLE_EXPOSURE_CHAINS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STIPPLE_EXPOSURE_CHAINS_INL_H
#undef STIPPLE_EXPOSURE_CHAINS_INL_H
#else
#define STIPPLE_EXPOSURE_CHAINS_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <type_traits>

#include "decoder/measurements.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {

/// The chains of exposures that are looked at; the voxels of others count as unobserved.
enum class Chain : std::uint8_t { kOnly, kFirst, kSecond };

template <Chain kChain>
std::uint8_t state_in(std::uint8_t state) {
    if (kChain == Chain::kOnly) return state;
    const bool second = (state & Measurements::kSecond) != 0;
    return second == (kChain == Chain::kSecond) ? state : 0;
}

/// Calls body(chain, weighted), both std::integral_constant, for each chain. Chains share no voxel,
/// so one after the other is both at once.
template <typename Body>
void for_each_chain(const Measurements& m, const Body& body) {
    const auto chains = [&](auto weighted) {
        if (!m.interleaved) return body(std::integral_constant<Chain, Chain::kOnly>{}, weighted);
        body(std::integral_constant<Chain, Chain::kFirst>{}, weighted);
        body(std::integral_constant<Chain, Chain::kSecond>{}, weighted);
    };
    m.weight.empty() ? chains(std::false_type{}) : chains(std::true_type{});
}

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
