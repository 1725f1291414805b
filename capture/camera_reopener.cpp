#include "capture/camera_reopener.h"

namespace stipple {
namespace {

using namespace std::chrono_literals;

/// A camera that answers lets go of its control channel within this time, and can be opened then.
constexpr auto kCloseFirst = 500ms;
constexpr auto kBetweenTries = 200ms;

}  // namespace

CameraReopener::CameraReopener(std::unique_ptr<Camera> gone, Opener open)
    : closing_([this, camera = std::move(gone)]() mutable { close(std::move(camera)); }),
      opening_([this, opener = std::move(open)](const std::stop_token& stop) {
          open_until_back(stop, opener);
      }) {}

void CameraReopener::close(std::unique_ptr<Camera> gone) {
    gone->stop();
    gone.reset();
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
}

void CameraReopener::open_until_back(const std::stop_token& stop, const Opener& open) {
    {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, stop, kCloseFirst, [&] { return closed_; });
    }
    while (!stop.stop_requested()) {
        try {
            auto camera = open();
            camera->start();
            const std::lock_guard lock(mutex_);
            back_ = std::move(camera);
            changed_.notify_all();
            return;
        } catch (...) {
            // Not back yet, or no memory for it. InputError, a setting that it took before: it is
            // not up yet, or it is another camera. Or the program is told to stop.
        }
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, stop, kBetweenTries, [] { return false; });
    }
}

std::unique_ptr<Camera> CameraReopener::take(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [&] { return back_ != nullptr; });
    taken_ = taken_ || back_ != nullptr;
    return std::move(back_);
}

bool CameraReopener::is_done() const {
    const std::lock_guard lock(mutex_);
    return closed_ && taken_;
}

}  // namespace stipple
