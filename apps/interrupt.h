#pragma once

namespace stipple {

/// Thrown where a run that was asked to stop has nothing worth keeping.
struct Interrupted {};

/// From here on the first SIGINT or SIGTERM only asks loops to stop, so that they finish their
/// output as a shorter one; the second ends the program at once. A full disk or a broken pipe
/// shows as a write error instead of a signal.
void catch_signals();

/// The signal that asked to stop, or 0.
[[nodiscard]] int stop_signal() noexcept;

/// \throws Interrupted if a signal asked to stop.
void throw_if_stopped();

}  // namespace stipple
