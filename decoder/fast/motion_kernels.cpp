// Compiled once per SIMD target by foreach_target.h, chosen at run time; every target gives the
// same bits.
#include "decoder/fast/gradient_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decoder/fast/motion_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "decoder/motion/motion.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Index = std::size_t;

struct Position {
    Index row;
    Index col;
};

/// For a vector of pixels of a row: the first of the four pixels around each partner, and how far
/// below and to the right of it the partner is.
template <typename D>
struct Partners {
    hn::Vec<hn::RebindToSigned<D>> row;
    hn::Vec<hn::RebindToSigned<D>> col;
    hn::Vec<hn::RebindToSigned<D>> first;  ///< row * cols + col
    hn::Vec<D> below;
    hn::Vec<D> right;
};

template <typename D>
Partners<D> partners(D d, const MotionLink& link, Position at) {
    const hn::RebindToSigned<D> di;
    const hn::Rebind<std::int16_t, D> d16;
    constexpr int kShift = 6;
    static_assert(1 << kShift == MotionField::kShiftsPerPixel);
    const auto scale = hn::Set(d, 1.0F / MotionField::kShiftsPerPixel);
    const auto split = [&](auto position, int last, auto& rest) {
        const auto whole = hn::Min(hn::ShiftRight<kShift>(position), hn::Set(di, last));
        rest = hn::Mul(hn::ConvertTo(d, hn::Sub(position, hn::ShiftLeft<kShift>(whole))), scale);
        return whole;
    };
    const Index i = at.row * static_cast<Index>(link.shape.cols) + at.col;
    const auto at_row = hn::Set(di, static_cast<int>(at.row << kShift));
    const auto at_col = hn::ShiftLeft<kShift>(hn::Iota(di, static_cast<std::int32_t>(at.col)));
    Partners<D> p;
    p.row = split(hn::Add(at_row, hn::PromoteTo(di, hn::LoadU(d16, link.row_shift + i))),
                  link.shape.rows - 2, p.below);
    p.col = split(hn::Add(at_col, hn::PromoteTo(di, hn::LoadU(d16, link.col_shift + i))),
                  link.shape.cols - 2, p.right);
    p.first = hn::Add(hn::Mul(p.row, hn::Set(di, link.shape.cols)), p.col);
    return p;
}

/// Bilinear weights of a pixel and its neighbours to the right, below and across.
template <typename D>
struct Bilinear {
    Bilinear(D d, const Partners<D>& p) {
        const auto one = hn::Set(d, 1.0F);
        const auto above = hn::Sub(one, p.below);
        const auto left = hn::Sub(one, p.right);
        weight[0] = hn::Mul(above, left);
        weight[1] = hn::Mul(above, p.right);
        weight[2] = hn::Mul(p.below, left);
        weight[3] = hn::Mul(p.below, p.right);
    }
    hn::Vec<D> weight[4];
};

template <typename D>
hn::Vec<D> weighted(const Bilinear<D>& b, const hn::Vec<D> (&corner)[4]) {
    return hn::Add(hn::Add(hn::Mul(b.weight[0], corner[0]), hn::Mul(b.weight[1], corner[1])),
                   hn::Add(hn::Mul(b.weight[2], corner[2]), hn::Mul(b.weight[3], corner[3])));
}

template <typename D>
hn::Vec<D> gathered(D d, const Partners<D>& p, const Bilinear<D>& b, const float* plane,
                    Index cols) {
    return weighted(b, {hn::GatherIndex(d, plane, p.first), hn::GatherIndex(d, plane + 1, p.first),
                        hn::GatherIndex(d, plane + cols, p.first),
                        hn::GatherIndex(d, plane + cols + 1, p.first)});
}

#if HWY_TARGET != HWY_SCALAR
/// Two vectors of a row, of which each lane takes a pixel.
template <typename D>
class RowPart {
  public:
    RowPart(D d, const float* row)
        : near_(hn::LoadU(d, row)), far_(hn::LoadU(d, row + hn::Lanes(d))) {}
    /// `at` is from 0 to 2 lanes - 1.
    hn::Vec<D> operator()(D d, hn::Vec<hn::RebindToSigned<D>> at) const {
        const hn::RebindToSigned<D> di;
        const auto lanes = static_cast<std::int32_t>(hn::Lanes(d));
        const auto lane = hn::IndicesFromVec(d, hn::And(at, hn::Set(di, lanes - 1)));
        return hn::IfThenElse(hn::RebindMask(d, hn::Lt(at, hn::Set(di, lanes))),
                              hn::TableLookupLanes(near_, lane), hn::TableLookupLanes(far_, lane));
    }

  private:
    hn::Vec<D> near_;
    hn::Vec<D> far_;
};

/// Where all partners of a vector lie close together, as neighbours that move together do: in two
/// rows, and in twice as many columns as there are lanes. Permuted loads of three rows take a
/// fourth of the time of gathers, and give the same.
template <typename D>
class Vicinity {
  public:
    Vicinity(D d, const Partners<D>& p, FrameShape shape) {
        const hn::RebindToSigned<D> di;
        const auto lanes = static_cast<std::int32_t>(hn::Lanes(d));
        auto row = hn::GetLane(p.row);
        if (!hn::AllFalse(di, hn::Lt(p.row, hn::Set(di, row)))) --row;
        const auto col = std::max(hn::GetLane(p.col) - lanes / 2, 0);
        below_ = hn::RebindMask(d, hn::Gt(p.row, hn::Set(di, row)));
        right_ = hn::Sub(p.col, hn::Set(di, col));
        const auto outside =
            hn::Or(hn::Or(hn::VecFromMask(di, hn::Lt(p.row, hn::Set(di, row))),
                          hn::VecFromMask(di, hn::Gt(p.row, hn::Set(di, row + 1)))),
                   hn::Or(hn::VecFromMask(di, hn::Lt(right_, hn::Zero(di))),
                          hn::VecFromMask(di, hn::Gt(right_, hn::Set(di, 2 * lanes - 2)))));
        first_ = static_cast<Index>(row) * static_cast<Index>(shape.cols) + static_cast<Index>(col);
        holds_ = lanes > 1 &&
                 first_ + 2 * static_cast<Index>(shape.cols) + 2 * hn::Lanes(d) <= shape.pixels() &&
                 hn::AllTrue(di, hn::Eq(outside, hn::Zero(di)));
    }
    [[nodiscard]] bool holds() const { return holds_; }

    hn::Vec<D> value_at(D d, const Bilinear<D>& b, const float* plane, Index cols) const {
        const RowPart<D> row[3] = {
            {d, plane + first_}, {d, plane + first_ + cols}, {d, plane + first_ + 2 * cols}};
        const auto next = hn::Add(right_, hn::Set(hn::RebindToSigned<D>(), 1));
        const auto pick = [&](int upper, auto at) {
            return hn::IfThenElse(below_, row[upper + 1](d, at), row[upper](d, at));
        };
        return weighted(b, {pick(0, right_), pick(0, next), pick(1, right_), pick(1, next)});
    }

  private:
    hn::Mask<D> below_;
    hn::Vec<hn::RebindToSigned<D>> right_;
    Index first_;
    bool holds_;
};
#endif

/// update_motion_dual, one vector of pixels at a time.
class DualUpdate {
  public:
    DualUpdate(const MotionLink& link, const DualStep& dual_step, const SlotPair& x,
               float* gradient)
        : link_(link), dual_step_(dual_step), x_(x), gradient_(gradient) {}

    template <typename D>
    void operator()(D d, Position at) const {
        const auto cols = static_cast<Index>(link_.shape.cols);
        const Index pixels = link_.shape.pixels();
        const Index pixel = at.row * cols + at.col;
        const auto p = partners(d, link_, at);
        const Bilinear<D> bilinear(d, p);
#if HWY_TARGET != HWY_SCALAR
        const Vicinity<D> vicinity(d, p, link_.shape);
#endif
        const auto value = [&](const float* plane) {
#if HWY_TARGET != HWY_SCALAR
            if (vicinity.holds()) return vicinity.value_at(d, bilinear, plane, cols);
#endif
            return gathered(d, p, bilinear, plane, cols);
        };
        const auto sigma = hn::Div(
            hn::Set(d, 1.0F),
            hn::Mul(hn::Set(d, dual_step_.coupling), hn::LoadU(d, dual_step_.step + pixel)));
        auto square = hn::Zero(d);
        for (Index plane = 0; plane < link_.shape.sites(); plane += pixels) {
            const Index i = plane + pixel;
            const auto difference = hn::Sub(value(x_.next + plane), hn::LoadU(d, x_.now + i));
            const auto dual = hn::Add(hn::LoadU(d, link_.dual + i), hn::Mul(sigma, difference));
            square = hn::Add(square, hn::Mul(dual, dual));
            hn::StoreU(dual, d, link_.dual + i);
        }
        const auto factor = shrinkage(d, pixel, square);
        for (Index i = pixel; i < link_.shape.sites(); i += pixels) {
            const auto dual = hn::Mul(hn::LoadU(d, link_.dual + i), factor);
            hn::StoreU(dual, d, link_.dual + i);
            hn::StoreU(hn::Sub(hn::LoadU(d, gradient_ + i), dual), d, gradient_ + i);
        }
    }

  private:
    /// What brings a dual of this squared norm back to where it must stay.
    template <typename D>
    hn::Vec<D> shrinkage(D d, Index pixel, hn::Vec<D> square) const {
        const hn::RebindToSigned<D> di;
        const hn::Rebind<std::uint8_t, D> d8;
        const auto confidence =
            hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d8, link_.confidence + pixel)));
        const auto weight = hn::Mul(hn::Set(d, dual_step_.weight),
                                    hn::Sqrt(hn::Div(hn::Set(d, dual_step_.reference_step),
                                                     hn::LoadU(d, dual_step_.step + pixel))));
        const auto bound = hn::Mul(hn::Mul(weight, confidence), hn::Set(d, 1.0F / 255));
        return hn::IfThenElseZero(hn::Gt(bound, hn::Zero(d)),
                                  hn::Div(bound, hn::Max(hn::Sqrt(square), bound)));
    }

    const MotionLink& link_;
    const DualStep& dual_step_;
    const SlotPair& x_;
    float* gradient_;
};

/// Calls body(d, col) for vectors of a row, then for its last pixels one at a time.
template <typename Body>
void for_each_vector(Index cols, const Body& body) {
    const hn::ScalableTag<float> d;
    Index col = 0;
    for (; col + hn::Lanes(d) <= cols; col += hn::Lanes(d)) body(d, col);
    for (; col < cols; ++col) body(hn::CappedTag<float, 1>(), col);
}

void update_frame(const MotionLink& link, const DualStep& dual_step, const SlotPair& x,
                  float* gradient) {
    const DualUpdate update(link, dual_step, x, gradient);
    for (Index row = 0; row < static_cast<Index>(link.shape.rows); ++row)
        for_each_vector(static_cast<Index>(link.shape.cols), [&](auto d, Index col) {
            update(d, {row, col});
        });
}

/// to[0] += from[0], to[1] += from[1]
void add_pair(const float* HWY_RESTRICT from, float* HWY_RESTRICT to) {
#if HWY_TARGET == HWY_SCALAR
    to[0] += from[0];
    to[1] += from[1];
#else
    const hn::FixedTag<float, 2> pair;
    hn::StoreU(hn::Add(hn::LoadU(pair, to), hn::LoadU(pair, from)), pair, to);
#endif
}

/// The duals of a stretch of a row in one plane, each split over the four pixels of its partner.
struct Shares {
    static constexpr Index kMaxPixels = 64;
    std::int32_t first[kMaxPixels];  ///< of the four
    HWY_ALIGN float share[4 * kMaxPixels];
};

/// Adds the shares of every other pixel, then those of the rest: neighbours often share two of
/// their four, and each would have to wait for the sum of the one before.
void add_shares(const Shares& shares, Index count, Index cols, float* gradient) {
    for (Index parity = 0; parity < 2; ++parity)
        for (Index i = parity; i < count; i += 2) {
            float* top = gradient + shares.first[i];
            add_pair(shares.share + 4 * i, top);
            add_pair(shares.share + 4 * i + 2, top + cols);
        }
}

void scatter_stretch(const MotionLink& link, Position at, Index count, float* gradient) {
    const auto cols = static_cast<Index>(link.shape.cols);
    __attribute__((uninitialized)) Shares shares;  // to zero it would take a 20th of the time
    for (Index plane = 0; plane < link.shape.sites(); plane += link.shape.pixels()) {
        const float* dual = link.dual + plane + at.row * cols + at.col;
        for_each_vector(count, [&](auto d, Index i) {
            const auto p = partners(d, link, {at.row, at.col + i});
            const Bilinear<decltype(d)> bilinear(d, p);
            const auto share = [&](int corner) {
                return hn::Mul(hn::LoadU(d, dual + i), bilinear.weight[corner]);
            };
            hn::StoreU(p.first, hn::RebindToSigned<decltype(d)>(), shares.first + i);
            hn::StoreInterleaved4(share(0), share(1), share(2), share(3), d, shares.share + 4 * i);
        });
        add_shares(shares, count, cols, gradient + plane);
    }
}

void scatter_frame(const MotionLink& link, float* gradient) {
    const auto cols = static_cast<Index>(link.shape.cols);
    for (Index row = 0; row < static_cast<Index>(link.shape.rows); ++row)
        for (Index col = 0; col < cols; col += Shares::kMaxPixels)
            scatter_stretch(link, {row, col}, std::min(Shares::kMaxPixels, cols - col), gradient);
}

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stipple {

HWY_EXPORT(update_frame);
HWY_EXPORT(scatter_frame);

void update_motion_dual(const MotionLink& link, const DualStep& dual_step, const SlotPair& x,
                        float* gradient) noexcept {
    HWY_DYNAMIC_DISPATCH(update_frame)(link, dual_step, x, gradient);
}

void add_partner_gradient(const MotionLink& link, float* gradient) noexcept {
    HWY_DYNAMIC_DISPATCH(scatter_frame)(link, gradient);
}

}  // namespace stipple
#endif  // HWY_ONCE
