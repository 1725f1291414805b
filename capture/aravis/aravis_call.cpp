#include "capture/aravis/aravis_call.h"

#include <arv.h>

#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <string_view>

#include "capture/open_camera.h"

namespace stipple {
namespace {

/// Tells each message of GLib and Aravis once.
class MessageFilter {
  public:
    void set(std::function<void(std::string_view)> tell) {
        const std::lock_guard lock(mutex_);
        tell_ = std::move(tell);
        told_.clear();
    }
    void add(std::string_view text) {
        constexpr std::size_t kMaxBytes = 200;
        constexpr std::size_t kMaxTexts = 20;
        const std::lock_guard lock(mutex_);
        if (told_.size() < kMaxTexts && told_.emplace(text.substr(0, kMaxBytes)).second)
            tell_(text.substr(0, kMaxBytes));
    }

  private:
    std::mutex mutex_;
    std::set<std::string> told_;
    std::function<void(std::string_view)> tell_;
};

void on_message(const char*, GLogLevelFlags level, const char* text, void* filter) {
    constexpr int kWorthTelling = G_LOG_LEVEL_ERROR | G_LOG_LEVEL_CRITICAL | G_LOG_LEVEL_WARNING;
    if ((level & kWorthTelling) != 0 && text != nullptr)
        static_cast<MessageFilter*>(filter)->add(text);
}

}  // namespace

void tell_camera_messages(std::function<void(std::string_view)> tell) {
    static auto* const filter = new MessageFilter;  // threads of Aravis may outlive statics
    filter->set(std::move(tell));
    g_log_set_default_handler(on_message, filter);
}

GlibError::~GlibError() {
    g_clear_error(&error_);
}

_GError** GlibError::slot() {
    g_clear_error(&error_);
    return &error_;
}

std::string GlibError::text() const {
    return error_ == nullptr ? std::string("no reason given") : std::string(error_->message);
}

void GlibError::check_answer(const std::string& address) const {
    if (g_error_matches(error_, ARV_DEVICE_ERROR, ARV_DEVICE_ERROR_TIMEOUT) != FALSE)
        throw DeviceError(address, "camera lost: it no longer answers (power, cable?)");
}

}  // namespace stipple
