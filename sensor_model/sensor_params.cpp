#include "sensor_model/sensor_params.h"

#include <fmt/format.h>

#include <string_view>

#include "core/error.h"

namespace stipple {
namespace {

void check(const SensorParams& params, std::string_view key, double value, ParameterRange range) {
    if (value >= range.least && value <= range.most) return;  // false for NaN
    throw InputError(fmt::format("sensor '{}': {}", params.name, key),
                     fmt::format("{} is outside {} .. {}", value, range.least, range.most));
}

}  // namespace

void validate(const SensorParams& params) {
    check(params, "photons_per_unit", params.photons_per_unit, SensorParams::kPhotonsPerUnit);
    check(params, "full_scale_e", params.full_scale_e, SensorParams::kFullScaleE);
    check(params, "full_well_e", params.full_well_e, SensorParams::kFullWellE);
    check(params, "read_noise_e", params.read_noise_e, SensorParams::kReadNoiseE);
    check(params, "bit_depth", params.bit_depth, SensorParams::kBitDepth);
    check(params, "slot_us", params.slot_us, SensorParams::kSlotUs);
    check(params, "charge_stores", params.charge_stores, SensorParams::kChargeStores);
}

}  // namespace stipple
