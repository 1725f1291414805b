#include "capture/camera_timing.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

namespace stipple {
namespace {

using std::chrono::nanoseconds;

/// A feature as a number; 0 if there is none.
double number_of(const CameraDescription& camera, const char* feature) {
    const auto found = camera.features.find(feature);
    if (found == camera.features.end()) return 0;
    double value = 0;
    const std::string& text = found->second;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    return end.ec == std::errc() && value > 0 ? value : 0;
}

}  // namespace

nanoseconds nominal_period(const CameraDescription& camera) {
    const double rate = number_of(camera, "AcquisitionFrameRate");
    const double exposure_us =
        std::max(number_of(camera, "ExposureTime"), number_of(camera, "ExposureTimeAbs"));
    const double seconds = std::max(rate > 0 ? 1 / rate : 0, exposure_us * 1e-6);
    return nanoseconds(std::llround(std::min(seconds, 3600.0) * 1e9));
}

bool waits_for_triggers(const CameraDescription& camera) {
    const auto mode = camera.features.find("TriggerMode");
    return mode != camera.features.end() && mode->second == "On";
}

std::uint64_t frames_before_first(const CameraDescription& camera, const StreamStart& start,
                                  const FrameRecord& first) {
    constexpr double kTolerance = 1.1;
    const nanoseconds period = nominal_period(camera);
    if (first.wire_id <= start.first_wire_id || period.count() == 0 || waits_for_triggers(camera))
        return 0;
    const std::uint64_t frames = first.wire_id - start.first_wire_id;
    const double needed_ns = static_cast<double>(frames) * static_cast<double>(period.count());
    const auto since_start_ns = static_cast<double>(first.host_monotonic_ns - start.monotonic_ns);
    return needed_ns <= kTolerance * since_start_ns ? frames : 0;
}

}  // namespace stipple
