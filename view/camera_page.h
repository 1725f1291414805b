#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "view/page_server.h"
#include "view/view_page.h"
#include "view/viewed_camera.h"

namespace stipple {

/// The page of a running camera. Features that the camera takes only while it stands still are set
/// by opening it anew; then the page begins anew. For several threads.
class CameraPage {
  public:
    /// Opens the camera. \throws as ViewedCamera and ViewPage.
    CameraPage(ViewedCameraOptions camera, ViewOptions view);

    /// As ViewPage::answer. The answer to "camera/set" has `reload`: whether the page begins anew;
    /// so it does with the key "stopped", and if the camera refuses.
    [[nodiscard]] std::optional<PageAnswer> answer(const PageRequest& request);
    /// As ViewPage::end.
    void end();
    [[nodiscard]] std::int64_t slots() { return shown()->page.slots(); }
    [[nodiscard]] FrameShape shape() { return shown()->page.shape(); }

  private:
    struct Shown {
        Shown(const ViewedCameraOptions& options, ViewOptions view);

        ViewedCamera camera;
        ViewPage page;
    };
    /// Waits while the camera is opened anew. \throws DeviceError if it is gone for good.
    [[nodiscard]] std::shared_ptr<Shown> shown();
    [[nodiscard]] PageAnswer set(const PageRequest& request);
    void open_anew(const CameraSettings& settings);

    ViewedCameraOptions camera_;
    ViewOptions view_;
    std::mutex setting_;  ///< one at a time
    std::mutex mutex_;    ///< of what follows
    std::condition_variable opened_;
    bool ended_ = false;
    std::shared_ptr<Shown> shown_;
};

}  // namespace stipple
