#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "capture/camera.h"

namespace stipple {

/// Opens a camera that is gone, again and again until it is back, in a thread of its own. Closing
/// the old one, which may take seconds where it does not answer, has another.
class CameraReopener {
  public:
    using Opener = std::function<std::unique_ptr<Camera>()>;

    /// Takes the camera that is gone and begins.
    CameraReopener(std::unique_ptr<Camera> gone, Opener open);
    /// Waits for both threads.
    ~CameraReopener() = default;
    CameraReopener(const CameraReopener&) = delete;
    CameraReopener& operator=(const CameraReopener&) = delete;

    /// The camera, open and started; null if it is not back within `timeout`.
    [[nodiscard]] std::unique_ptr<Camera> take(std::chrono::milliseconds timeout);
    /// Whether the old one is closed and the new one taken, so that nothing is left to wait for.
    [[nodiscard]] bool is_done() const;

  private:
    void close(std::unique_ptr<Camera> gone);
    void open_until_back(const std::stop_token& stop, const Opener& open);

    mutable std::mutex mutex_;
    std::condition_variable_any changed_;
    bool closed_ = false;
    bool taken_ = false;
    std::unique_ptr<Camera> back_;
    std::jthread closing_;  ///< last: they use the others
    std::jthread opening_;
};

}  // namespace stipple
