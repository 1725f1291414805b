#pragma once

#include <functional>
#include <string>

#include "readout/provenance.h"

namespace stipple {

/// The origin of footage that lies in files: those of a folder or pattern in the order of frames.
/// Reads them all; `check` is called before each MiB, and may throw to give up.
/// \throws InputError if one cannot be read.
[[nodiscard]] FootageOrigin origin_of(const std::string& footage, const FootageOptions& reading,
                                      const std::function<void()>& check);

}  // namespace stipple
