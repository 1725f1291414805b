#pragma once

#include <string>
#include <vector>

#include "tests/support/golden_file.h"

namespace stipple {

/// One small recording per packing and feature of the format, and one per kind of damage.
[[nodiscard]] std::vector<GoldenCase> golden_recordings();

}  // namespace stipple
