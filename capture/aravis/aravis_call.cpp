#include "capture/aravis/aravis_call.h"

#include <arv.h>

namespace stipple {

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
