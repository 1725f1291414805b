#pragma once

#include <functional>

namespace stipple {

/// Told now and then which fraction of the work is done; false stops.
using ProgressCallback = std::function<bool(double fraction)>;

}  // namespace stipple
