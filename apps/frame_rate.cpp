#include "apps/frame_rate.h"

#include <fmt/format.h>

#include <cmath>

namespace stipple {
namespace {

constexpr std::uint64_t kLeastFrames = 8;
/// Clocks of cameras agree to 0.01 %; arrivals of frames jitter by several ms in a second.
constexpr double kTolerance = 0.02;

std::int64_t stamp_ns(const FrameRecord& record) {
    const bool none = record.stamp_source == StampSource::kNone ||
                      record.stamp_source == StampSource::kUnnamedClock;
    return none ? record.host_monotonic_ns : record.device_ns;
}

}  // namespace

void FrameRate::add(const FrameRecord& record) {
    if (!first_ || first_->epoch != record.epoch || first_->stamp_source != record.stamp_source)
        first_ = record;
    last_ = record;
}

double FrameRate::seconds() const {
    return first_ ? static_cast<double>(stamp_ns(last_) - stamp_ns(*first_)) * 1e-9 : 0;
}

double FrameRate::hz() const {
    if (!first_ || last_.id < first_->id + kLeastFrames || seconds() <= 0) return 0;
    return static_cast<double>(last_.id - first_->id) / seconds();
}

std::string rate_warning(double frames_hz, const SensorParams& sensor) {
    const double slots_hz = 1e6 / sensor.slot_us;
    if (frames_hz == 0 || std::abs(frames_hz / slots_hz - 1) <= kTolerance) return {};
    return fmt::format(
        "the camera sends {:.4g} frames/s, but a slot of sensor \"{}\" takes {:g} us ({:.4g} a "
        "second): times in the stream are wrong. Set AcquisitionFrameRate={:.4g} of the camera, or "
        "slot_us={:.5g} of the sensor",
        frames_hz, sensor.name, sensor.slot_us, slots_hz, slots_hz, 1e6 / frames_hz);
}

}  // namespace stipple
