#pragma once

#include <functional>

namespace stipple {

/// Receives the completed work from time to time, in the thread of the caller: slots in `decode`, a
/// fraction 0..1 elsewhere. Returns false to stop at once.
using ProgressCallback = std::function<bool(double done)>;

}  // namespace stipple
