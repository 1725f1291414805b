#pragma once

#include <functional>

namespace stipple {

/// Receives the completed fraction of the work from time to time; false stops.
using ProgressCallback = std::function<bool(double fraction)>;

}  // namespace stipple
