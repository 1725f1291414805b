#pragma once

#include <functional>
#include <string>

namespace stipple {

/// Calls `body(name)` once for each SIMD target that this machine runs, with dispatch forced to
/// it; the last call is with the best one. Dispatch is free again afterwards.
void for_each_simd_target(const std::function<void(const std::string&)>& body);

}  // namespace stipple
