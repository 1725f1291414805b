#pragma once

#include <string>

struct _GError;  // the name that GLib gives it. NOLINT(bugprone-reserved-identifier)

namespace stipple {

/// Takes what a function of GLib or Aravis has to complain of.
class GlibError {
  public:
    ~GlibError();
    GlibError() = default;
    GlibError(const GlibError&) = delete;
    GlibError& operator=(const GlibError&) = delete;
    /// For the next call.
    _GError** slot();
    [[nodiscard]] bool any() const { return error_ != nullptr; }
    [[nodiscard]] std::string text() const;
    /// \throws DeviceError at `address` if the camera has not answered, for which Aravis waits 3 s:
    /// each further question would wait as long.
    void check_answer(const std::string& address) const;

  private:
    _GError* error_ = nullptr;
};

}  // namespace stipple
