#include "sensor_model/sensor_config.h"

#include <cmath>

#include "core/config.h"
#include "core/error.h"
#include "sensor_model/sensor_keys.h"

namespace stipple {
namespace {

void reject_physical_keys(const Config& config, const PhysicalTerms& terms) {
    visit_physical_keys(terms, [&](const ConfigKey& key, const auto&) {
        if (config.contains(key.name))
            throw InputError(
                config.where(key.name),
                "is of the physical model; set mode = \"physical\" (mode is \"paper\", "
                "which has the terms of Eq. 1 only)");
    });
}

}  // namespace

SensorParams read_sensor(Config& config) {
    SensorParams params;
    visit_sensor_keys(params, KeyReader(config));
    if (params.mode == SensorMode::kPaper) {
        reject_physical_keys(config, params.physical);
    } else {
        double& black_level_dn = params.physical.black_level_dn;
        black_level_dn = std::nan("");  // its default depends on the other keys
        visit_physical_keys(params.physical, KeyReader(config));
        if (std::isnan(black_level_dn)) black_level_dn = default_black_level_dn(params);
    }
    validate(params);
    return params;
}

}  // namespace stipple
