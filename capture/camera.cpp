#include "capture/camera.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include "core/text.h"

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

void Camera::set(const std::string& feature, const std::string&) {
    throw InputError(feature, "a replay has no settings");
}

void FramePool::reserve(std::size_t frames, std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    frames_ = frames;
    bytes_ = bytes;
    free_.reserve(frames);
    for (std::size_t i = 0; i < frames; ++i) {
        free_.emplace_back(bytes);  // zeros: each page is written to
        free_.back().clear();
    }
}

std::vector<std::uint8_t> FramePool::take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) {
        ++misses_;
        return {};
    }
    auto payload = std::move(free_.back());
    free_.pop_back();
    return payload;
}

void FramePool::give_back(std::vector<std::uint8_t>&& payload) {
    const std::lock_guard lock(mutex_);
    if (free_.size() == frames_ || payload.capacity() < bytes_) return;
    payload.clear();
    free_.push_back(std::move(payload));
}

std::uint64_t FramePool::misses() const {
    const std::lock_guard lock(mutex_);
    return misses_;
}

std::optional<std::int64_t> integer_setting(std::string_view text) {
    constexpr std::string_view kHexadecimal = "0x";
    if (text.substr(0, 2) != kHexadecimal) return parsed_number<std::int64_t>(text);
    const std::string_view digits = text.substr(2);
    return digits.substr(0, 1) == "-" ? std::nullopt : parsed_number<std::int64_t>(digits, 16);
}

std::optional<double> number_setting(std::string_view text) {
    const auto value = parsed_number<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

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
