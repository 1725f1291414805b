#pragma once

namespace stipple {

/// Of this build: "1.2.3".
[[nodiscard]] const char* version() noexcept;

}  // namespace stipple
