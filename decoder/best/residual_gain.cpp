#include "decoder/best/residual_gain.h"

#include <algorithm>
#include <cstdint>

#include "decoder/measurements.h"

namespace stipple {

float samples_per_voxel(const Measurements& measurements) {
    std::ptrdiff_t samples = 0;
    for_each_sensor(measurements, [&](const Measurements& sensor) {
        samples += std::ranges::count_if(
            sensor.state, [](std::uint8_t state) { return (state & Measurements::kLast) != 0; });
    });
    return static_cast<float>(static_cast<double>(samples) /
                              static_cast<double>(measurements.voxels()));
}

}  // namespace stipple
