#include "view/camera_page.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "core/error.h"

namespace stipple {
namespace {

/// For what the page asks while the camera is opened anew.
constexpr std::chrono::seconds kOpening{20};

ViewOptions with_camera(ViewOptions options, ViewedCamera& camera) {
    options.camera = &camera;
    return options;
}

}  // namespace

CameraPage::Shown::Shown(const ViewedCameraOptions& options, ViewOptions view)
    : camera(options), page(with_camera(std::move(view), camera)) {}

CameraPage::CameraPage(ViewedCameraOptions camera, ViewOptions view)
    : camera_(std::move(camera)),
      view_(std::move(view)),
      shown_(std::make_shared<Shown>(camera_, view_)) {}

std::shared_ptr<CameraPage::Shown> CameraPage::shown() {
    std::unique_lock lock(mutex_);
    opened_.wait_for(lock, kOpening, [&] { return shown_ != nullptr || ended_; });
    if (!shown_) throw DeviceError(camera_.address, "is not open");
    return shown_;
}

void CameraPage::end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    opened_.notify_all();
    if (shown_) shown_->page.end();
}

std::optional<PageAnswer> CameraPage::answer(const PageRequest& request) {
    if (request.acts && request.path == "camera/set") return set(request);
    return shown()->page.answer(request);
}

/// Ends what is shown, so that the camera is free.
void CameraPage::open_anew(const CameraSettings& settings) {
    std::shared_ptr<Shown> old;
    {
        const std::lock_guard lock(mutex_);
        old = std::move(shown_);
        shown_.reset();
    }
    if (old) old->page.end();
    while (old && old.use_count() > 1) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (old) camera_.sensor = old->camera.sensor();
    old.reset();
    camera_.settings = settings;
    auto opened = std::make_shared<Shown>(camera_, view_);
    const std::lock_guard lock(mutex_);
    shown_ = std::move(opened);
    opened_.notify_all();
}

PageAnswer CameraPage::set(const PageRequest& request) {
    const std::lock_guard one_at_a_time(setting_);
    const std::string feature = request.text("feature"), value = request.text("value");
    CameraSettings before;
    bool stopped = request.keys.contains("stopped");
    {
        const auto now = shown();
        before = now->camera.settings();
        if (!stopped) try {
                now->camera.set(feature, value);
            } catch (const DeviceError&) {  // perhaps only while frames come
                stopped = true;
            }
        if (stopped && now->camera.records())
            throw InputError(feature, "cannot change while the camera is recorded; stop first");
    }
    if (stopped) try {
            open_anew(with_setting(before, feature, value));
        } catch (...) {
            open_anew(before);
            throw;
        }
    return {"application/json", nlohmann::json{{"reload", stopped}}.dump()};
}

}  // namespace stipple
