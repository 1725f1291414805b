#include "python/camera.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <utility>

#include "capture/camera_kind.h"
#include "capture/capture_figures.h"
#include "capture/live_camera.h"
#include "capture/open_camera.h"
#include "core/config.h"
#include "core/error.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/figures_dict.h"
#include "python/footage.h"
#include "python/sensor.h"

namespace stipple::python {
namespace {

CameraSettings settings_for(const py::dict& settings,
                            const std::optional<std::filesystem::path>& config) {
    const auto texts = settings_of(settings);
    if (!config) return Config(texts, "camera").entries();
    return reading(*config, [&] { return Config(*config, texts, "camera").entries(); });
}

CaptureLimits limits_of(std::optional<std::int64_t> frames, std::optional<double> seconds) {
    if (frames && *frames < 1)
        throw InputError("frames", fmt::format("{} is not above 0", *frames));
    if (seconds && !(*seconds > 0))
        throw InputError("seconds", fmt::format("{} is not above 0", *seconds));
    return {.frames = static_cast<std::uint64_t>(frames.value_or(0)),
            .seconds = seconds.value_or(0)};
}

SessionOptions session_of(const std::string& address, const std::string& incomplete,
                          std::int64_t stall_ms, bool reconnect) {
    constexpr std::int64_t kMaxMs = SessionOptions::kMaxStall.count();
    if (stall_ms < 0 || stall_ms > kMaxMs)
        throw InputError("stall_ms", fmt::format("{} is outside 0..{}", stall_ms, kMaxMs));
    return session_options(address,
                           {.incomplete = value_in(kIncompletePolicies, incomplete, "incomplete"),
                            .stall = std::chrono::milliseconds(stall_ms),
                            .reconnect = reconnect});
}

}  // namespace

CaptureSession::Opener CameraTask::opener() const {
    return [address = address, settings = settings, buffers = buffers] {
        return open_image_camera(address, settings, buffers);
    };
}

std::size_t queue_of(std::size_t frames) {
    constexpr std::size_t kMax = LiveCameraOptions::kMaxWaitingFrames;
    if (frames < 1 || frames > kMax)
        throw InputError("queue", fmt::format("{} is outside 1..{}", frames, kMax));
    return frames;
}

bool CameraTask::is_replay() const {
    return camera_kind(address).is_replay;
}

void SessionWarnings::take(const SessionEvent& event) {
    if (const auto* const outage = std::get_if<Outage>(&event))
        take(fmt::format("camera lost ({}); reopening it", outage->reason));
    if (const auto* const recovery = std::get_if<Recovery>(&event))
        take(fmt::format("the camera is back after {:.1f} s", recovery->gone_s));
    if (const auto* const lost = std::get_if<DeviceLost>(&event)) take(lost->warning);
}

void SessionWarnings::take(Message text) {
    const std::lock_guard lock(mutex_);
    texts_.push_back(std::move(text));
}

void SessionWarnings::pass_on() {
    std::vector<Message> texts;
    {
        const std::lock_guard lock(mutex_);
        texts.swap(texts_);
    }
    for (const Message& text : texts) warn(text);
}

py::dict lost_dict(const SessionTotals& totals) {
    return dict_of([&](const auto& add) { visit_lost_figures(totals, add); });
}

py::dict transport_dict(const TransportCounts& counts) {
    return dict_of([&](const auto& add) { visit_transport_figures(counts, add); });
}

void bind_camera(py::module_& module) {
    py::class_<CameraTask>(module, "CameraTask")
        .def(py::init(
            [](const std::string& address, const py::dict& settings,
               const std::optional<std::filesystem::path>& config, int buffers,
               const std::tuple<std::string, std::int64_t, bool>& session,
               const std::tuple<std::optional<std::int64_t>, std::optional<double>>& limits) {
                const auto& [incomplete, stall_ms, reconnect] = session;
                const auto& [frames, seconds] = limits;
                return CameraTask{.address = address,
                                  .settings = settings_for(settings, config),
                                  .buffers = CameraBuffers{.frames = buffers},
                                  .session = session_of(address, incomplete, stall_ms, reconnect),
                                  .limits = limits_of(frames, seconds)};
            }));
}

}  // namespace stipple::python
