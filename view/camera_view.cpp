#include "view/camera_view.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "capture/camera_search.h"
#include "capture/capture_figures.h"
#include "study/report/json_figures.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMaxEvents = 100;

}  // namespace

void CameraEvents::add(const std::string& text) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
    const std::lock_guard lock(mutex_);
    events_.emplace_back(passed.count(), text);
    if (events_.size() > kMaxEvents) events_.pop_front();
}

void CameraEvents::add(const SessionEvent& event) {
    if (const auto* const outage = std::get_if<Outage>(&event))
        add("the camera is lost: " + outage->reason);
    if (const auto* const back = std::get_if<Recovery>(&event))
        add(fmt::format("the camera is back after {:.1f} s", back->gone_s));
    if (const auto* const lost = std::get_if<DeviceLost>(&event)) add(lost->reason);
}

ordered_json CameraEvents::json() const {
    const std::lock_guard lock(mutex_);
    ordered_json events = ordered_json::array();
    for (const auto& [seconds, text] : events_)
        events.push_back({{"seconds", seconds}, {"text", text}});
    return events;
}

ViewedSensor::ViewedSensor(SensorChoice choice, const SensorSetup& setup, ColourFilter mosaic,
                           std::string fixed)
    : fixed_(fixed.empty() ? no_switch_text(setup) : std::move(fixed)),
      control_(std::move(choice), setup, mosaic) {}

void ViewedSensor::change(const std::string& changes, CameraEvents& events) {
    if (!fixed_.empty()) throw InputError("sensor", fixed_);
    const std::int64_t slot = control_.change(changes);
    events.add(fmt::format("from slot {} {}", slot, changes));
}

void ViewedSensor::apply(std::int64_t slots,
                         const std::function<std::int64_t(const SensorSetup&)>& switch_to) {
    if (slots > 0) control_.apply(switch_to);
}

ordered_json ViewedSensor::json() const {
    const SensorChoice now = control_.choice();
    return {{"schedule", now.schedule}, {"seed", now.seed}, {"fixed", or_null(fixed_)}};
}

std::uint64_t all_lost(const LostFrames& lost) {
    return std::accumulate(lost.begin(), lost.end(), std::uint64_t{0});
}

ordered_json CameraView::features() const {
    ordered_json list = ordered_json::array();
    for (const CameraFeature& feature : camera_features(address(), ""))
        list.push_back(json_of([&](const auto& add) { visit_feature_figures(feature, add); }));
    return list;
}

}  // namespace stipple
