#pragma once

#include <cstdint>
#include <optional>

namespace stipple {

/// How long to capture; 0: until stopped.
struct CaptureLimits {
    std::uint64_t frames = 0;
    double seconds = 0;

    /// True if a limit is reached.
    [[nodiscard]] bool reached(std::uint64_t taken_frames, double elapsed_s) const {
        return (frames > 0 && taken_frames >= frames) || (seconds > 0 && elapsed_s >= seconds);
    }
    /// The frames that there will be, if that is known.
    [[nodiscard]] std::optional<std::int64_t> total() const {
        return frames == 0 ? std::nullopt : std::optional(static_cast<std::int64_t>(frames));
    }
};

}  // namespace stipple
