#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sensor_model/sensor_params.h"

namespace stipple {

/// The column ADC. In paper mode it is the ADC part of Eq. 1,
///
///     DN = [clamp(q (2^d - 1) / s, 0, 2^d - 1)],   q the electrons of a sample, s the full scale,
///
/// where the bracket is the nearest integer (halves up) or the integer below. q (2^d - 1) / s is
/// evaluated in double, where the product is exact, so halves are exact and the bits are the same
/// on every machine. Physical mode adds two errors to the level y = q (2^d - 1) / s + black level:
/// the integral non-linearity 4 i x (1 - x), with x = y / (2^d - 1) clamped to 0..1 and the peak i
/// = `inl_dn`; and an error of each transition level, uniform within +-dnl_dn / 2 and fixed for
/// `device_id`, so that no code width is wrong by more than dnl_dn. `convert` is `convert_one` for
/// a list.
///
/// Not modelled: dither, differences between the ADCs of the columns, conversion time, noise of the
/// ADC (part of the read noise).
class ColumnAdc {
  public:
    /// Precondition: `validate(params)` passes.
    explicit ColumnAdc(const SensorParams& params);

    [[nodiscard]] std::uint16_t max_dn() const {
        return static_cast<std::uint16_t>(transfer_.max_dn);
    }

    /// Precondition: not NaN.
    [[nodiscard]] std::uint16_t convert_one(float electrons) const noexcept {
        return plain_ ? transfer_.convert(electrons) : convert_physical(electrons);
    }

    /// Precondition: equal lengths; no electrons are NaN.
    void convert(std::span<const float> electrons, std::span<std::uint16_t> dn) const noexcept;

  private:
    /// Eq. 1.
    struct TransferFunction {
        double full_scale_e;
        double max_dn;    ///< 2^d - 1
        double to_round;  ///< added before truncation

        [[nodiscard]] double clamped(double level) const noexcept {
            const double above = level > 0 ? level : 0;
            return above < max_dn ? above : max_dn;
        }
        [[nodiscard]] std::uint16_t convert(float electrons) const noexcept {
            const double level = static_cast<double>(electrons) * max_dn / full_scale_e;
            return static_cast<std::uint16_t>(static_cast<std::int32_t>(clamped(level) + to_round));
        }
    };

    [[nodiscard]] std::uint16_t convert_physical(float electrons) const noexcept;

    TransferFunction transfer_;
    bool plain_;  ///< Eq. 1 only
    double black_level_dn_;
    double inl_dn_;
    std::vector<float> step_error_;  ///< by the DN above the transition level; empty: none
};

}  // namespace stipple
