#include "decoder/joint/joint_prox.h"

#include "decoder/measurements.h"

namespace stipple {

JointProx::JointProx(const Measurements& measurements) {
    const bool several = !measurements.others.empty();
    for_each_sensor(measurements, [&](const Measurements& sensor) {
        sensors_.push_back({sensor, std::vector<float>(several ? sensor.voxels() : 0)});
    });
}

void JointProx::operator()(const SiteRun& run, std::span<const float> step, std::span<float> v,
                           int sweeps) noexcept {
    if (sensors_.size() == 1) return data_prox(sensors_.front().measurements, run, step, v);
    for (Sensor& sensor : sensors_) add_duals(sensor.measurements, run, step, {v, sensor.dual});
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (Sensor& sensor : sensors_) data_prox(sensor.measurements, run, step, {v, sensor.dual});
}

}  // namespace stipple
