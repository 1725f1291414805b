#include "readout/column_adc.h"

#include <cassert>
#include <cstddef>

#include "core/philox.h"

namespace stipple {
namespace {

/// How far the step up to each DN lies beside its place, uniform within dnl_dn / 2.
std::vector<float> step_errors(const SensorParams& params) {
    const PhysicalTerms& terms = params.physical;
    if (terms.dnl_dn == 0) return {};
    std::vector<float> errors(std::size_t{1} << static_cast<unsigned>(params.bit_depth));
    for (std::size_t dn = 0; dn < errors.size(); ++dn) {
        const auto words =
            philox4x32(random_address(static_cast<std::uint32_t>(dn), terms.device_id,
                                      RandomPurpose::kConverterPattern),
                       0);
        const double within = (static_cast<double>(words[0]) + 0.5) * 0x1p-32 - 0.5;
        errors[dn] = static_cast<float>(terms.dnl_dn * within);
    }
    return errors;
}

}  // namespace

ColumnAdc::ColumnAdc(const SensorParams& params)
    : transfer_{.full_scale_e = params.full_scale_e,
                .max_dn = static_cast<double>((1 << params.bit_depth) - 1),
                .to_round = params.rounding == Rounding::kNearest ? 0.5 : 0.0},
      plain_(params.mode == SensorMode::kPaper),
      black_level_dn_(params.physical.black_level_dn),
      inl_dn_(params.physical.inl_dn),
      step_error_(step_errors(params)) {}

std::uint16_t ColumnAdc::convert_physical(float electrons) const noexcept {
    const double straight =
        static_cast<double>(electrons) * transfer_.max_dn / transfer_.full_scale_e +
        black_level_dn_;
    const double x = transfer_.clamped(straight) / transfer_.max_dn;
    const double level =
        transfer_.clamped(straight + 4 * inl_dn_ * x * (1 - x)) + transfer_.to_round;
    auto dn = static_cast<std::int32_t>(level);
    if (step_error_.empty()) return static_cast<std::uint16_t>(dn);
    const auto step_to = [&](std::int32_t code) {
        return code + static_cast<double>(step_error_[static_cast<std::size_t>(code)]);
    };
    if (dn > 0 && level < step_to(dn))
        --dn;
    else if (dn < max_dn() && level >= step_to(dn + 1))
        ++dn;
    return static_cast<std::uint16_t>(dn);
}

void ColumnAdc::convert(std::span<const float> electrons,
                        std::span<std::uint16_t> dn) const noexcept {
    assert(electrons.size() == dn.size());
    if (!plain_) {
        for (std::size_t i = 0; i < dn.size(); ++i) dn[i] = convert_physical(electrons[i]);
        return;
    }
    const TransferFunction transfer =
        transfer_;  // a copy that `dn` cannot alias, so the loop vectorises
    for (std::size_t i = 0; i < dn.size(); ++i) dn[i] = transfer.convert(electrons[i]);
}

}  // namespace stipple
