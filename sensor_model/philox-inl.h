// Philox4x32-10 many at a time; included once per SIMD target (Highway), so without #pragma once.
#if defined(STIPPLE_PHILOX_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STIPPLE_PHILOX_INL_H
#undef STIPPLE_PHILOX_INL_H
#else
#define STIPPLE_PHILOX_INL_H
#endif

#include <hwy/highway.h>

#include "sensor_model/sample_words.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

/// Words 0 and 1 of the blocks whose counter word 0 stands in the low half of each 64-bit lane
/// (high halves are ignored and left undefined).
template <class D64, class V64 = hn::Vec<D64>>
HWY_INLINE void philox_low_halves(D64 d64, V64 c0, const SampleAddress& address, V64& word0,
                                  V64& word1) {
    const hn::Repartition<std::uint32_t, D64> d32;
    const PhiloxCounter counter =
        random_address(0, address.slot, RandomPurpose::kSample, address.plane);
    const auto multiplier0 = hn::Set(d32, 0xD2511F53U);
    const auto multiplier1 = hn::Set(d32, 0xCD9E8D57U);
    auto c1 = hn::Set(d64, counter[1]);
    auto c2 = hn::Set(d64, counter[2]);
    auto c3 = hn::Set(d64, counter[3]);
    auto key0 = static_cast<std::uint32_t>(address.seed);
    auto key1 = static_cast<std::uint32_t>(address.seed >> 32U);
    for (int round = 0; round < 10; ++round) {
        const auto product0 = hn::MulEven(hn::BitCast(d32, c0), multiplier0);
        const auto product1 = hn::MulEven(hn::BitCast(d32, c2), multiplier1);
        c0 = hn::Xor(hn::Xor(hn::ShiftRight<32>(product1), c1), hn::Set(d64, key0));
        c2 = hn::Xor(hn::Xor(hn::ShiftRight<32>(product0), c3), hn::Set(d64, key1));
        c1 = product1;
        c3 = product0;
        key0 += 0x9E3779B9U;
        key1 += 0xBB67AE85U;
    }
    word0 = c0;
    word1 = c1;
}

/// Words kShot and kRead of a vector of pixels.
template <class D32, class V32 = hn::Vec<D32>>
HWY_INLINE void sample_words(D32 d32, V32 pixel, const SampleAddress& address, V32& shot,
                             V32& read) {
    const hn::Repartition<std::uint64_t, D32> d64;
    const auto even = hn::BitCast(d64, pixel);
    hn::Vec<decltype(d64)> even0, even1, odd0, odd1;
    philox_low_halves(d64, even, address, even0, even1);
    philox_low_halves(d64, hn::ShiftRight<32>(even), address, odd0, odd1);
    shot = hn::OddEven(hn::BitCast(d32, hn::ShiftLeft<32>(odd0)), hn::BitCast(d32, even0));
    read = hn::OddEven(hn::BitCast(d32, hn::ShiftLeft<32>(odd1)), hn::BitCast(d32, even1));
}

#endif  // HWY_TARGET != HWY_SCALAR

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
