#include "view/live_view.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "capture/capture_figures.h"
#include "core/error.h"
#include "study/report/json_figures.h"

namespace stipple {

LiveView::LiveView(const LiveCamera& camera, double black_level_dn, const SensorSetup& setup,
                   ViewedSensor& sensor, std::string file)
    : address_(camera.description().address),
      name_(fmt::format("{} {}", camera.description().vendor, camera.description().model)),
      file_(std::move(file)),
      sensor_(sensor),
      recent_(camera.layout(), black_level_dn, stream_header_of(setup, {})) {}

void LiveView::switch_sensor(StreamRecorder& recorder) {
    sensor_.apply(recorder.emulator().stats().slots, [&](const SensorSetup& next) {
        ScheduleSwitch made = recorder.switch_to(next);
        const std::int64_t slot = made.slot;
        recent_.add(std::move(made));
        return slot;
    });
}

void LiveView::change_sensor(const std::string& changes) {
    sensor_.change(changes, events_);
}

void LiveView::note(const LiveEmulation& now) {
    const std::lock_guard lock(mutex_);
    for (const auto& [name, cause] : kGapCauses) {
        const auto at = static_cast<std::size_t>(cause);
        if (now.totals.lost[at] > totals_.lost[at])
            events_.add(fmt::format("{} lost: {}", now.totals.lost[at] - totals_.lost[at], name));
    }
    totals_ = now.totals;
    frames_ = now.latencies.count();
    skipped_ = now.dropped_slots;
    frames_hz_ = now.rate.hz();
}

nlohmann::ordered_json LiveView::status() const {
    const std::lock_guard lock(mutex_);
    return {
        {"frames", frames_},
        {"frames_hz", or_null(frames_hz_)},
        {"lost", json_of([&](const auto& add) { visit_lost_figures(totals_, add); })},
        {"incomplete", totals_.incomplete},
        {"outages", totals_.outages},
        {"skipped", skipped_},
        {"recording",
         {{"file", file_}, {"frames", frames_}, {"lost", all_lost(totals_.lost)}, {"stop", false}}},
        {"sensor", sensor_.json()},
        {"events", events_.json()},
        {"ended", nullptr}};
}

void LiveView::record() {
    throw InputError(file_, "is being written from begin to end");
}

void LiveView::stop_recording() {
    throw InputError(file_,
                     "ends with the program, at Ctrl-C or at its limit of frames or seconds");
}

}  // namespace stipple
