#include "decoder/joint/joint_measurements.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"
#include "stream/schedule_switch.h"

namespace stipple {
namespace {

/// The pixel of a sensor that each pixel of a window takes: row-major in the array, or -1.
std::vector<std::int64_t> pixels_of(const VideoWindow& window, FrameShape array,
                                    const Homography& map) {
    std::vector<std::int64_t> pixels;
    pixels.reserve(window.shape.pixels());
    for (int row = 0; row < window.shape.rows; ++row)
        for (int col = 0; col < window.shape.cols; ++col)
            pixels.push_back(
                nearest_pixel(array, map({static_cast<double>(window.first_row + row),
                                          static_cast<double>(window.first_col + col)})));
    return pixels;
}

/// The smallest window of a sensor with all these pixels; without rows if there are none.
VideoWindow window_around(const std::vector<std::int64_t>& pixels, FrameShape array,
                          VideoWindow window) {
    std::int64_t top = array.rows, left = array.cols, bottom = -1, right = -1;
    for (const std::int64_t pixel : pixels) {
        if (pixel < 0) continue;
        const std::int64_t row = pixel / array.cols;
        const std::int64_t col = pixel % array.cols;
        top = std::min(top, row);
        bottom = std::max(bottom, row);
        left = std::min(left, col);
        right = std::max(right, col);
    }
    if (bottom < 0) top = left = bottom = right = 0;
    window.first_row = static_cast<int>(top);
    window.first_col = static_cast<int>(left);
    window.shape.rows = static_cast<int>(bottom - top + 1);
    window.shape.cols = static_cast<int>(right - left + 1);
    return window;
}

/// The place of each pixel in the sensor's window instead of its array.
void move_into(const VideoWindow& own, FrameShape array, std::vector<std::int64_t>& pixels) {
    for (std::int64_t& pixel : pixels)
        if (pixel >= 0)
            pixel = (pixel / array.cols - own.first_row) * own.shape.cols +
                    (pixel % array.cols - own.first_col);
}

/// An array of one value per voxel, of the pixels that are taken; `absent` of others.
template <typename Value>
std::vector<Value> taken(const std::vector<Value>& from, const Measurements& own,
                         const Measurements& window, const std::vector<std::int64_t>& pixels,
                         Value absent) {
    if (from.empty()) return {};
    std::vector<Value> to(index(window.slots) * window.shape.sites(), absent);
    parallel_for(0, window.slots * window.shape.planes, [&](int plane) {
        const Value* const source = &from[index(plane) * own.shape.pixels()];
        Value* const target = &to[index(plane) * window.shape.pixels()];
        for (std::size_t i = 0; i < pixels.size(); ++i)
            if (pixels[i] >= 0) target[i] = source[pixels[i]];
    });
    return to;
}

Measurements collect_one(const SensorSamples& sensor, VideoWindow window) {
    window.first_slot -= sensor.view.phase_slots;
    const Homography& map = sensor.view.from_reference;
    if (map.is_identity()) return collect_measurements(sensor.header, sensor.packets, window);
    const FrameShape array = sensor.header.shape;
    auto pixels = pixels_of(window, array, map);
    const VideoWindow own_window = window_around(pixels, array, window);
    move_into(own_window, array, pixels);
    const Measurements own = collect_measurements(sensor.header, sensor.packets, own_window);
    Measurements result{.slots = own.slots,
                        .shape = window.shape,
                        .state = {},
                        .sum = {},
                        .variance = {},
                        .interleaved = own.interleaved,
                        .mosaic = own.mosaic};
    result.state = taken(own.state, own, result, pixels, std::uint8_t{0});
    result.sum = taken(own.sum, own, result, pixels, 0.0F);
    result.variance = taken(own.variance, own, result, pixels, 0.0F);
    result.dark_variance = taken(own.dark_variance, own, result, pixels, 0.0F);
    result.variance_per_light = taken(own.variance_per_light, own, result, pixels, 0.0F);
    result.weight = taken(own.weight, own, result, pixels, 1.0F);
    return result;
}

/// Gives each exposure the noise of its sensor, as it is among others now.
void add_own_noise(Measurements& m, const SampleNoise& noise) {
    m.lsb_light = noise.lsb_light();
    if (!m.dark_variance.empty()) return;
    m.dark_variance.resize(m.voxels());
    m.variance_per_light.resize(m.voxels());
    for (std::size_t i = 0; i < m.voxels(); ++i) {
        if ((m.state[i] & Measurements::kLast) == 0) continue;
        m.dark_variance[i] = noise.variance(0);
        m.variance_per_light[i] = noise.per_light();
    }
}

}  // namespace

Measurements collect_joint(std::span<const SensorSamples> sensors, const VideoWindow& window) {
    Measurements first = collect_one(sensors.front(), window);
    if (sensors.size() == 1) return first;
    add_own_noise(first, SampleNoise(sensors.front().header.calibration));
    for (const SensorSamples& sensor : sensors.subspan(1)) {
        Measurements other = collect_one(sensor, window);
        add_own_noise(other, SampleNoise(sensor.header.calibration));
        first.mosaic = first.mosaic || other.mosaic;
        first.others.push_back(std::move(other));
    }
    merge_equal_exposures(first);
    return first;
}

Calibration joint_calibration(std::span<const SensorSamples> sensors, std::int64_t slot) {
    Calibration joint = calibration_at(sensors.front().header, slot);
    if (sensors.size() == 1) return joint;
    joint.electrons_per_unit = 0;
    double inverse_variance = 0;
    for (const SensorSamples& sensor : sensors) {
        const Calibration& own = sensor.header.calibration;
        joint.electrons_per_unit += own.electrons_per_unit;
        inverse_variance += 1 / static_cast<double>(SampleNoise(own).variance(0));
        joint.noise_free = joint.noise_free && own.noise_free;
    }
    // A DN stays that of the first sensor; its rounding is a part of the noise.
    const auto lsb_light =
        static_cast<double>(SampleNoise(sensors.front().header.calibration).lsb_light());
    const double read_variance = std::max(1 / inverse_variance - lsb_light * lsb_light / 12, 0.0);
    joint.gain_e_per_dn = joint.electrons_per_unit * lsb_light;
    joint.read_noise_e = joint.electrons_per_unit * std::sqrt(read_variance);
    return joint;
}

}  // namespace stipple
