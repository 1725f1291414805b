// SIMD form of poisson_one; included once per SIMD target (Highway), so without #pragma once.
#if defined(STIPPLE_POISSON_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STIPPLE_POISSON_INL_H
#undef STIPPLE_POISSON_INL_H
#else
#define STIPPLE_POISSON_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "sensor_model/normal-inl.h"
#include "sensor_model/poisson.h"
#include "sensor_model/poisson_sum.h"
#include "sensor_model/poisson_table.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

/// exp(-x) for 0 <= x <= 700, double.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp_of_minus(D d, V x) {
    using namespace poisson_sum;
    const hn::Rebind<std::int32_t, D> d_int;
    const hn::RebindToSigned<D> d_bits;
    const auto n = hn::DemoteTo(d_int, mul_then_add(x, hn::Set(d, kLog2E), hn::Set(d, 0.5)));
    const V n_double = hn::PromoteTo(d, n);
    const V r = mul_then_add(n_double, hn::Set(d, kLn2Low),
                             hn::Sub(hn::Mul(n_double, hn::Set(d, kLn2High)), x));
    const auto exponent = hn::Sub(hn::Set(d_bits, 1023), hn::PromoteTo(d_bits, n));
    return hn::Mul(polynomial(d, kExp, r), hn::BitCast(d, hn::ShiftLeft<52>(exponent)));
}

/// The probability u of words, exact, double.
template <class D, class VW>
HWY_INLINE hn::Vec<D> uniform_of(D d, VW word) {
    using V = hn::Vec<D>;
    const hn::Rebind<std::int32_t, D> d_int;
    const V half_word = hn::PromoteTo(d, hn::BitCast(d_int, hn::ShiftRight<1>(word)));
    const V tail = hn::Mul(hn::Add(half_word, hn::Set(d, 0.5)), hn::Set(d, 0x1p-32));
    const auto bit0 = hn::And(hn::BitCast(d_int, word), hn::Set(d_int, 1));
    const auto lower = hn::Gt(hn::PromoteTo(d, bit0), hn::Zero(d));
    return hn::IfThenElse(lower, tail, hn::Sub(hn::Set(d, 1.0), tail));
}

/// `poisson_by_sum` of a vector. Both halves go round one loop, which hides the latency of the
/// sums.
template <class D, class V, class VW>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> poisson_by_sum(D, V mean, VW word) {
    const hn::Half<D> half;
    const hn::RebindToUnsigned<decltype(half)> half_word;
    const hn::Repartition<double, D> dd;
    const auto mean0 = hn::PromoteTo(dd, hn::LowerHalf(half, mean));
    const auto mean1 = hn::PromoteTo(dd, hn::UpperHalf(half, mean));
    const auto u0 = uniform_of(dd, hn::LowerHalf(half_word, word));
    const auto u1 = uniform_of(dd, hn::UpperHalf(half_word, word));
    const auto one = hn::Set(dd, 1.0);
    auto term0 = exp_of_minus(dd, mean0), term1 = exp_of_minus(dd, mean1);
    auto sum0 = term0, sum1 = term1;
    auto count0 = hn::Zero(dd), count1 = count0;
    for (const double reciprocal : poisson_sum::kReciprocal) {
        const auto below0 = hn::Gt(u0, sum0), below1 = hn::Gt(u1, sum1);
        if (hn::AllFalse(dd, hn::Or(below0, below1))) break;
        count0 = hn::Add(count0, hn::IfThenElseZero(below0, one));
        count1 = hn::Add(count1, hn::IfThenElseZero(below1, one));
        term0 = hn::Mul(term0, hn::Mul(mean0, hn::Set(dd, reciprocal)));
        term1 = hn::Mul(term1, hn::Mul(mean1, hn::Set(dd, reciprocal)));
        sum0 = hn::Add(sum0, term0);
        sum1 = hn::Add(sum1, term1);
    }
    const hn::RebindToSigned<D> di;
    const hn::Half<decltype(di)> half_int;
    return hn::Combine(di, hn::DemoteTo(half_int, count1), hn::DemoteTo(half_int, count0));
}

/// The term that is added to floor(mean): see `Quantile` of the scalar form.
template <class V>
HWY_INLINE V quantile_rest(V mean, V w, V g, V c) {
    const V fraction = hn::Sub(mean, hn::Floor(mean));
    return mul_then_add(hn::Sqrt(mean), w, mul_then_add(hn::Mul(w, w), g, hn::Add(c, fraction)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> quantile_count(D, V mean, V rest) {
    const hn::RebindToSigned<D> di;
    const auto whole = hn::ConvertTo(di, hn::Floor(mean));
    return hn::Max(hn::Add(whole, hn::ConvertTo(di, hn::Floor(rest))), hn::Zero(di));
}

/// Puts `poisson_by_sum` in place of the counts of the doubtful lanes.
template <class D, class V, class VW, class VI, class M>
HWY_NOINLINE VI recheck(D d, V mean, VW word, VI count, M doubtful) {
    const hn::RebindToSigned<D> di;
    const hn::RebindToUnsigned<D> du;
    HWY_ALIGN float means[hn::MaxLanes(d)];
    HWY_ALIGN std::uint32_t words[hn::MaxLanes(d)];
    HWY_ALIGN std::int32_t counts[hn::MaxLanes(d)];
    HWY_ALIGN std::int32_t flags[hn::MaxLanes(d)];
    hn::Store(mean, d, means);
    hn::Store(word, du, words);
    hn::Store(count, di, counts);
    hn::Store(hn::VecFromMask(di, hn::RebindMask(di, doubtful)), di, flags);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane)
        if (flags[lane] != 0)
            counts[lane] =
                static_cast<std::int32_t>(stipple::poisson_by_sum(means[lane], words[lane]));
    return hn::Load(di, counts);
}

/// Counts of means in [kSumBelow, kShortFrom], with the normal deviates `w` of the words.
template <class D, class VW, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> poisson_middle(D d, V mean, VW word, V w) {
    using namespace poisson_table;
    const V inverse_root = hn::Div(hn::Set(d, 1.0F), hn::Sqrt(mean));
    const V inverse = hn::Mul(inverse_root, inverse_root);
    const V s = hn::Mul(w, inverse_root);
    const V t = hn::Max(hn::Min(s, hn::Set(d, kMaxS)), hn::Set(d, kMinS));
    const V c12 = mul_then_add(polynomial(d, kC2, t), inverse, polynomial(d, kC1, t));
    const V c = mul_then_add(c12, inverse, polynomial(d, kC0, t));
    const V rest = quantile_rest(mean, w, polynomial(d, kG, t), c);
    const auto count = quantile_count(d, mean, rest);
    const V off_middle = hn::Abs(hn::Sub(hn::Sub(rest, hn::Floor(rest)), hn::Set(d, 0.5F)));
    const auto near_integer = hn::Gt(off_middle, hn::Set(d, 0.5F - kDoubtfulX));
    const auto far_tail = hn::Gt(hn::Abs(w), hn::Set(d, kDoubtfulW));
    const auto doubtful = hn::And(hn::Or(hn::Or(near_integer, far_tail), hn::Ne(s, t)),
                                  hn::Lt(mean, hn::Set(d, kRecheckBelow)));
    if (HWY_LIKELY(hn::AllFalse(d, doubtful))) return count;
    return recheck(d, mean, word, count, doubtful);
}

/// Counts of means in [kShortFrom, kMaxPoissonMean].
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> poisson_large(D d, V mean, V w) {
    using namespace poisson_table;
    const V inverse_root = hn::Div(hn::Set(d, 1.0F), hn::Sqrt(mean));
    const V s = hn::Mul(w, inverse_root);
    const V c = mul_then_add(polynomial(d, kShortC1, s), hn::Mul(inverse_root, inverse_root),
                             polynomial(d, kShortC0, s));
    return quantile_count(d, mean, quantile_rest(mean, w, polynomial(d, kShortG, s), c));
}

/// A vector of Poisson draws. Neighbours mostly have similar means, so most vectors need one method
/// only. In a mixed vector each method runs with a harmless mean in the lanes of the others: a mean
/// of 0 ends the sum at once, and kShortFrom is never rechecked.
template <class D, class VW, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> poisson(D d, V mean, VW word) {
    using namespace poisson_table;
    const hn::RebindToSigned<D> di;
    const V short_from = hn::Set(d, kShortFrom);
    const auto small = hn::Lt(mean, hn::Set(d, kSumBelow));
    if (hn::AllTrue(d, small)) return poisson_by_sum(d, mean, word);
    const auto large = hn::Ge(mean, short_from);
    const V bounded = hn::Min(mean, hn::Set(d, kMaxPoissonMean));
    const V w = normal(d, word);
    if (hn::AllTrue(d, large)) return poisson_large(d, bounded, w);

    auto count = hn::Zero(di);
    const auto not_middle = hn::Or(small, large);
    if (!hn::AllTrue(d, not_middle))
        count = poisson_middle(d, hn::IfThenElse(not_middle, short_from, mean), word, w);
    if (!hn::AllFalse(d, large)) {
        const auto many = poisson_large(d, hn::Max(bounded, short_from), w);
        count = hn::IfThenElse(hn::RebindMask(di, large), many, count);
    }
    if (!hn::AllFalse(d, small)) {
        const auto few = poisson_by_sum(d, hn::IfThenElseZero(small, mean), word);
        count = hn::IfThenElse(hn::RebindMask(di, small), few, count);
    }
    return count;
}

#endif  // HWY_TARGET != HWY_SCALAR

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
