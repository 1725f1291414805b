#include "sensor_model/sensor_config.h"

#include "core/error.h"

namespace stipple {
namespace {

double read(Config& config, const char* key, double fallback, ParameterRange range) {
    return config.number(key, fallback, range.least, range.most);
}

std::int64_t read_integer(Config& config, const char* key, int fallback, ParameterRange range) {
    return config.integer(key, fallback, static_cast<std::int64_t>(range.least),
                          static_cast<std::int64_t>(range.most));
}

void require_paper_mode(Config& config) {
    if (config.choice("mode", "paper", {"paper", "physical"}) == "paper") return;
    throw InputError(config.place("mode"),
                     "\"physical\" is not implemented yet; use \"paper\" (Eq. 1)");
}

}  // namespace

SensorParams read_sensor(Config& config) {
    require_paper_mode(config);
    SensorParams params;
    params.name = config.text("name", params.name);
    params.photons_per_unit =
        read(config, "photons_per_unit", params.photons_per_unit, SensorParams::kPhotonsPerUnit);
    params.full_scale_e =
        read(config, "full_scale_e", params.full_scale_e, SensorParams::kFullScaleE);
    params.full_well_e = read(config, "full_well_e", params.full_well_e, SensorParams::kFullWellE);
    params.read_noise_e =
        read(config, "read_noise_e", params.read_noise_e, SensorParams::kReadNoiseE);
    params.shot_noise = config.boolean("shot_noise", params.shot_noise);
    params.bit_depth = static_cast<int>(
        read_integer(config, "bit_depth", params.bit_depth, SensorParams::kBitDepth));
    if (config.choice("rounding", "nearest", {"nearest", "floor"}) == "floor")
        params.rounding = AdcRounding::kFloor;
    params.slot_us = read(config, "slot_us", params.slot_us, SensorParams::kSlotUs);
    params.charge_stores = static_cast<int>(
        read_integer(config, "charge_stores", params.charge_stores, SensorParams::kChargeStores));
    return params;
}

}  // namespace stipple
