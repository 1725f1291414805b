#include "readout/column_adc.h"

#include <cassert>
#include <cstddef>

namespace stipple {

ColumnAdc::ColumnAdc(const SensorParams& params)
    : full_scale_e_(params.full_scale_e),
      most_dn_((1 << params.bit_depth) - 1),
      to_round_(params.rounding == AdcRounding::kNearest ? 0.5 : 0.0) {}

void ColumnAdc::convert(std::span<const float> electrons,
                        std::span<std::uint16_t> dn) const noexcept {
    assert(electrons.size() == dn.size());
    const ColumnAdc adc = *this;  // a copy that `dn` cannot alias, so the loop vectorises
    for (std::size_t i = 0; i < dn.size(); ++i) dn[i] = adc.convert_one(electrons[i]);
}

}  // namespace stipple
