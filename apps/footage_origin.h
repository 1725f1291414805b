#pragma once

#include <string>

#include "readout/provenance.h"

namespace stipple {

/// The origin of footage that lies in files: those of a folder or pattern in the order of frames.
/// Reads them all. \throws InputError if one cannot be read, Interrupted.
[[nodiscard]] FootageOrigin origin_of(const std::string& footage, const FootageOptions& reading);

}  // namespace stipple
