#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "capture/camera.h"

namespace stipple {

/// Tries to open a lost camera in a thread until it is back. Another thread closes the old one,
/// which may take seconds if it does not answer.
class CameraReopener {
  public:
    using Opener = std::function<std::unique_ptr<Camera>()>;

    /// Takes the lost camera and begins.
    CameraReopener(std::unique_ptr<Camera> gone, Opener open);
    /// Waits for both threads.
    ~CameraReopener() = default;
    CameraReopener(const CameraReopener&) = delete;
    CameraReopener& operator=(const CameraReopener&) = delete;

    /// The camera, open and started; null after `timeout`.
    [[nodiscard]] std::unique_ptr<Camera> take(std::chrono::milliseconds timeout);
    /// Whether the old camera is closed and the new one taken.
    [[nodiscard]] bool is_done() const;

  private:
    void close(std::unique_ptr<Camera> gone);
    void open_until_back(const std::stop_token& stop, const Opener& open);

    mutable std::mutex mutex_;
    std::condition_variable_any changed_;
    bool closed_ = false;
    bool taken_ = false;
    std::unique_ptr<Camera> back_;
    std::jthread closing_;  ///< last: the threads use the other members
    std::jthread opening_;
};

}  // namespace stipple
