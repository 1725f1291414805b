#pragma once

#include <cstdint>
#include <span>

#include "sensor_model/sensor_params.h"

namespace stipple {

/// The converter at the foot of the columns: the outside of the paper's Eq. 1,
///
///     DN = [(2^d - 1) clamp(q / s, 0, 1)],   q the electrons of a sample, s the full scale,
///
/// where the bracket is the nearest integer (halves up) or the integer below. Evaluated as
/// q (2^d - 1) / s in double, whose product is exact, so that halves are halves; the same bits on
/// every machine. `convert` is `convert_one`, many at a time.
///
/// Not modelled: black level, non-linearity, dither, conversion time.
class ColumnAdc {
  public:
    /// Precondition: `validate(params)` passes.
    explicit ColumnAdc(const SensorParams& params);

    [[nodiscard]] std::uint16_t most_dn() const { return static_cast<std::uint16_t>(most_dn_); }

    /// Precondition: not NaN.
    [[nodiscard]] std::uint16_t convert_one(float electrons) const noexcept {
        const double level = static_cast<double>(electrons) * most_dn_ / full_scale_e_;
        const double above = level > 0 ? level : 0;
        const double within = above < most_dn_ ? above : most_dn_;
        return static_cast<std::uint16_t>(static_cast<std::int32_t>(within + to_round_));
    }

    /// Precondition: equal lengths; no electrons are NaN.
    void convert(std::span<const float> electrons, std::span<std::uint16_t> dn) const noexcept;

  private:
    double full_scale_e_;
    double most_dn_;   ///< 2^d - 1
    double to_round_;  ///< added before the fraction is cut off
};

}  // namespace stipple
