#include "capture/level_warning.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>

namespace stipple {
namespace {

constexpr double kToleranceDn = 1;

/// Bits of the white level: files keep numbers of 10 or 12 bits in words of 16.
int used_bits(double white_dn) {
    return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(white_dn)));
}

}  // namespace

Message black_level_warning(const std::string& file, const SourceInfo& footage,
                            const SensorParams& sensor) {
    const double sensor_dn = sensor.physical.black_level_dn;
    if (sensor.mode != SensorMode::kPhysical || !footage.black_dn || !footage.white_dn) return {};
    if (used_bits(*footage.white_dn) != sensor.bit_depth ||
        std::abs(*footage.black_dn - sensor_dn) <= kToleranceDn)
        return {};
    return fmt::format(
               "{}: its black level is {:g} DN, that of sensor \"{}\" {:g} DN, both of {} bits: "
               "light is right, but if the sensor stands for this camera, use ",
               file, *footage.black_dn, sensor.name, sensor_dn, sensor.bit_depth) +
           Parameter{"sensor.black_level_dn", fmt::format("{:g}", *footage.black_dn)};
}

}  // namespace stipple
