#pragma once

#include <chrono>
#include <cstdint>

namespace stipple {

/// CLOCK_MONOTONIC: nanoseconds since some start of the host.
[[nodiscard]] inline std::int64_t monotonic_ns() {
    return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// CLOCK_REALTIME: nanoseconds since 1970, UTC; may be set back.
[[nodiscard]] inline std::int64_t realtime_ns() {
    return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace stipple
