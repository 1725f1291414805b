#include "capture/sensor_warnings.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>

namespace stipple {
namespace {

constexpr std::uint64_t kMinPeriods = 8;
/// Clocks of cameras agree to 0.01 %; arrivals of frames jitter by several ms in a second.
constexpr double kTolerance = 0.02;

bool agree(double frames_hz, const SensorParams& sensor) {
    return std::abs(frames_hz * sensor.slot_us * 1e-6 - 1) <= kTolerance;
}

/// The rate, if it is known and not that of the slots.
std::optional<double> other_rate(const FrameRate& frames, const SensorParams& sensor) {
    if (frames.periods() < kMinPeriods) return std::nullopt;
    const auto hz = frames.hz();
    return hz && !agree(*hz, sensor) ? hz : std::nullopt;
}

std::string slot_text(const SensorParams& sensor) {
    return fmt::format("a slot of sensor \"{}\" takes {:g} us ({:.4g} a second)", sensor.name,
                       sensor.slot_us, 1e6 / sensor.slot_us);
}

/// The setting by which a slot is a frame.
Parameter slot_of(double frames_hz) {
    return {"sensor.slot_us", fmt::format("{:.5g}", 1e6 / frames_hz)};
}

constexpr double kToleranceDn = 1;

/// Bits of the white level: files keep numbers of 10 or 12 bits in words of 16.
int used_bits(double white_dn) {
    return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(white_dn)));
}

}  // namespace

Message camera_rate_warning(const FrameRate& frames, const SensorParams& sensor) {
    const auto hz = other_rate(frames, sensor);
    if (!hz) return {};
    return fmt::format(
               "the camera sends {:.4g} frames/s, but {}: times in the stream are wrong; use ", *hz,
               slot_text(sensor)) +
           Parameter{"camera.AcquisitionFrameRate", fmt::format("{:.4g}", 1e6 / sensor.slot_us)} +
           " or " + slot_of(*hz);
}

Message recording_rate_warning(const std::string& file, const FrameRate& frames,
                               const SensorParams& sensor) {
    const auto hz = other_rate(frames, sensor);
    if (!hz) return {};
    return fmt::format(
               "{}: the camera sent {:.4g} frames/s, but {}: times in the stream are wrong; use ",
               file, *hz, slot_text(sensor)) +
           slot_of(*hz);
}

Message video_rate_warning(const std::string& file, double frames_hz, const SensorParams& sensor) {
    if (agree(frames_hz, sensor)) return {};
    return fmt::format("{}: has {:.4g} frames/s, but {}: motion in the stream is {:.3g}x as fast. ",
                       file, frames_hz, slot_text(sensor), 1e6 / sensor.slot_us / frames_hz) +
           slot_of(frames_hz) + " keeps the speed; " +
           Parameter{"resample", frames_hz * sensor.slot_us < 1e6 ? "flow" : "blend"} +
           fmt::format(" makes frames of {:.4g} a second", 1e6 / sensor.slot_us);
}

std::string exposure_warning(const std::string& file, double exposure_us,
                             const SensorParams& sensor) {
    if (exposure_us <= (1 + kTolerance) * sensor.slot_us) return {};
    return fmt::format("{}: its frames were exposed for {:.4g} us, but {}: motion is blurred", file,
                       exposure_us, slot_text(sensor));
}

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
