#pragma once

#include <chrono>
#include <string>
#include <type_traits>
#include <utility>

#include "core/abandonable_call.h"
#include "core/error.h"

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

/// The result of `work` with the camera at `address`, for which Aravis waits as long as the camera
/// asks it to (PENDING_ACK). `work` must own what it uses. \throws DeviceError after two minutes,
/// and what `work` throws.
template <typename Work>
[[nodiscard]] std::invoke_result_t<Work&> within_limited_time(const std::string& address,
                                                              Work work) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    auto result =
        call_unless(std::move(work), [end] { return std::chrono::steady_clock::now() > end; });
    if (!result) throw DeviceError(address, "camera lost: it did not answer in two minutes");
    return std::move(*result);
}

}  // namespace stipple
