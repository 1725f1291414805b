#pragma once

#include <csignal>
#include <string_view>
#include <type_traits>

#include "core/abandonable_call.h"

namespace stipple {

/// Thrown when a stopped run has nothing worth keeping.
struct Interrupted {
    std::string_view left;  ///< a remark on its outputs, for the message; may be empty
};

/// From here on the first SIGINT, SIGTERM or SIGHUP only asks loops to stop, so that they finish
/// their output as a shorter one; reads that wait are interrupted (EINTR). Half a second later a
/// second one ends the program at once, and says where unfinished outputs lie. A full disk or a
/// broken pipe shows as a write error instead of a signal.
void catch_signals();

/// Standard streams that are closed become /dev/null, so that no file that is opened takes their
/// place, and the messages that are meant for them.
void reserve_standard_streams();

/// The signal that asked to stop, or 0.
[[nodiscard]] int stop_signal() noexcept;

/// \throws Interrupted if a signal asked to stop. `left` is a literal.
void throw_if_stopped(std::string_view left = {});

/// The result of `work`, which may wait for a camera; a signal ends the waiting at once. `work`
/// must own what it uses. \throws Interrupted, and what `work` throws.
template <typename Work>
[[nodiscard]] std::invoke_result_t<Work&> interruptible(Work work) {
    auto result = call_unless(std::move(work), [] { return stop_signal() != 0; });
    if (!result) throw Interrupted{};
    return std::move(*result);
}

/// While it lives, the signals that `catch_signals` catches wait: for libraries that take a poll()
/// that one interrupts for a fault.
class SignalBlocker {
  public:
    SignalBlocker();
    ~SignalBlocker();
    SignalBlocker(const SignalBlocker&) = delete;
    SignalBlocker& operator=(const SignalBlocker&) = delete;

  private:
    sigset_t before_{};
};

}  // namespace stipple
