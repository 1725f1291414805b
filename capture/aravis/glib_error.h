#pragma once

#include <arv.h>

#include <string>

#include "core/error.h"

namespace stipple {

/// Takes what a function of GLib or Aravis has to complain of.
class GlibError {
  public:
    ~GlibError() { g_clear_error(&error_); }
    GlibError() = default;
    GlibError(const GlibError&) = delete;
    GlibError& operator=(const GlibError&) = delete;
    GError** slot() {
        g_clear_error(&error_);
        return &error_;
    }
    [[nodiscard]] bool any() const { return error_ != nullptr; }
    [[nodiscard]] std::string text() const {
        return error_ == nullptr ? std::string("no reason given") : std::string(error_->message);
    }
    /// \throws DeviceError at `address` if the camera has not answered, for which Aravis waits 3 s:
    /// each further question would wait as long.
    void check_answer(const std::string& address) const {
        if (g_error_matches(error_, ARV_DEVICE_ERROR, ARV_DEVICE_ERROR_TIMEOUT) != FALSE)
            throw DeviceError(address, "camera lost: it no longer answers (power, cable?)");
    }

  private:
    GError* error_ = nullptr;
};

}  // namespace stipple
