// normal_one many at a time; included once per SIMD target (Highway), so without #pragma once.
#if defined(STIPPLE_NORMAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STIPPLE_NORMAL_INL_H
#undef STIPPLE_NORMAL_INL_H
#else
#define STIPPLE_NORMAL_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "sensor_model/normal_table.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

/// a b + c with two roundings. Not hn::MulAdd: it fuses on some targets, which changes bits.
template <class V>
HWY_INLINE V mul_then_add(V a, V b, V c) {
    return hn::Add(hn::Mul(a, b), c);
}

/// `horner` (portable_math.h), step by step.
template <class D, std::size_t n, class V = hn::Vec<D>>
HWY_INLINE V polynomial(D d, const hn::TFromD<D> (&c)[n], V x) {
    V sum = hn::Set(d, c[n - 1]);
    for (std::size_t i = n - 1; i > 0; --i) sum = mul_then_add(sum, x, hn::Set(d, c[i - 1]));
    return sum;
}

/// Natural logarithm of normal numbers x > 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V log_of(D d, V x) {
    using namespace normal_table;
    const hn::RebindToSigned<D> di;
    const auto bits = hn::BitCast(di, x);  // x > 0: the sign bit is clear
    const auto shifted = hn::Sub(hn::ShiftRight<23>(bits), hn::Set(di, 126));
    const auto fraction = hn::And(bits, hn::Set(di, 0x007FFFFF));
    const V mantissa = hn::BitCast(d, hn::Or(fraction, hn::Set(di, 0x3F000000)));
    const auto low = hn::Lt(mantissa, hn::Set(d, kSqrtHalf));
    const V one = hn::Set(d, 1.0F);
    const V exponent = hn::Sub(hn::ConvertTo(d, shifted), hn::IfThenElseZero(low, one));
    const V z = hn::Sub(hn::Add(mantissa, hn::IfThenElseZero(low, mantissa)), one);
    const V z2 = hn::Mul(z, z);
    V y = hn::Mul(hn::Mul(polynomial(d, kLog, z), z), z2);
    y = mul_then_add(exponent, hn::Set(d, kLn2Low), y);
    y = mul_then_add(z2, hn::Set(d, -0.5F), y);
    return mul_then_add(exponent, hn::Set(d, kLn2High), hn::Add(z, y));
}

/// Standard normal deviates of a vector of words.
template <class D, class VU = hn::Vec<hn::RebindToUnsigned<D>>>
HWY_INLINE hn::Vec<D> normal(D d, VU word) {
    using namespace normal_table;
    using V = hn::Vec<D>;
    const hn::RebindToSigned<D> di;
    const auto half_word = hn::BitCast(di, hn::ShiftRight<1>(word));
    const auto other_half = hn::Sub(hn::Set(di, 0x7FFFFFFF), half_word);
    const V half = hn::Set(d, 0.5F), one = hn::Set(d, 1.0F);
    const V tail = hn::Mul(hn::Add(hn::ConvertTo(d, half_word), half), hn::Set(d, 0x1p-32F));
    const V x = hn::Mul(hn::Add(hn::ConvertTo(d, other_half), half), hn::Set(d, 0x1p-31F));
    const V both_tails = hn::Mul(hn::Set(d, 4.0F), hn::Mul(tail, hn::Sub(one, tail)));
    const V l = hn::Sub(hn::Zero(d), log_of(d, both_tails));
    V p = polynomial(d, kCentre, hn::Sub(l, hn::Set(d, 2.5F)));
    const auto far = hn::Ge(l, hn::Set(d, kTailFrom));
    if (HWY_UNLIKELY(!hn::AllFalse(d, far))) {  // one word in 300
        const V q = polynomial(d, kTail, hn::Sub(hn::Sqrt(l), hn::Set(d, 3.0F)));
        p = hn::IfThenElse(far, q, p);
    }
    return hn::Xor(hn::Mul(p, x), hn::BitCast(d, hn::ShiftLeft<31>(word)));
}

#endif  // HWY_TARGET != HWY_SCALAR

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
