#include "sensor_model/sensor_config.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "sensor_model/physical_keys.h"

namespace stipple {
namespace {

/// Keys of the physical mode that are not single numbers.
constexpr const char* kOtherPhysicalKeys[] = {"row_noise_e", "device_id",     "cfa",     "map_rows",
                                              "map_cols",    "transmittance", "gain_map"};

double read(Config& config, const char* key, double fallback, ParameterRange range) {
    return config.number(key, fallback, range.least, range.most);
}

std::vector<double> read_list(Config& config, const char* key, ParameterRange range) {
    return config.numbers(key, {}, range.least, range.most);
}

int read_integer(Config& config, const char* key, int fallback, ParameterRange range) {
    return static_cast<int>(config.integer(key, fallback, static_cast<std::int64_t>(range.least),
                                           static_cast<std::int64_t>(range.most)));
}

void reject_physical_keys(Config& config) {
    const auto reject = [&](const char* key) {
        if (config.contains(key))
            throw InputError(
                config.place(key),
                "is of the physical model; set mode = \"physical\" (mode is \"paper\", "
                "which has the terms of Eq. 1 only)");
    };
    for (const PhysicalKey& key : kPhysicalKeys) reject(key.name);
    for (const char* key : kOtherPhysicalKeys) reject(key);
}

PhysicalTerms read_terms(Config& config) {
    PhysicalTerms terms;
    for (const PhysicalKey& key : kPhysicalKeys)
        terms.*key.term = read(config, key.name, terms.*key.term, key.range);
    terms.row_noise_e = read_list(config, "row_noise_e", kRowNoiseE);
    terms.device_id =
        static_cast<std::uint32_t>(config.integer("device_id", terms.device_id, 0, UINT32_MAX));
    const std::vector<std::string> names(kColourFilterNames.begin(), kColourFilterNames.end());
    const auto filter = std::ranges::find(names, config.choice("cfa", names.front(), names));
    terms.cfa = static_cast<ColourFilter>(filter - names.begin());
    terms.map_rows = read_integer(config, "map_rows", terms.map_rows, {1, kMaxMapSide});
    terms.map_cols = read_integer(config, "map_cols", terms.map_cols, {1, kMaxMapSide});
    terms.transmittance = read_list(config, "transmittance", kTransmittance);
    terms.gain_map = read_list(config, "gain_map", kRelativeGain);
    return terms;
}

void read_physical(Config& config, SensorParams& params) {
    if (config.choice("mode", "paper", {"paper", "physical"}) == "paper")
        return reject_physical_keys(config);
    params.mode = SensorMode::kPhysical;
    params.physical = read_terms(config);
    if (!config.contains("black_level_dn"))
        params.physical.black_level_dn = default_black_level_dn(params);
}

}  // namespace

SensorParams read_sensor(Config& config) {
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
    params.bit_depth = read_integer(config, "bit_depth", params.bit_depth, SensorParams::kBitDepth);
    if (config.choice("rounding", "nearest", {"nearest", "floor"}) == "floor")
        params.rounding = AdcRounding::kFloor;
    params.slot_us = read(config, "slot_us", params.slot_us, SensorParams::kSlotUs);
    params.charge_stores =
        read_integer(config, "charge_stores", params.charge_stores, SensorParams::kChargeStores);
    read_physical(config, params);
    validate(params);
    return params;
}

}  // namespace stipple
