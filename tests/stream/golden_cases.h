#pragma once

#include <string>
#include <vector>

#include "tests/support/golden_file.h"

namespace stipple {

/// The stream of the example in docs/stream_format.md.
[[nodiscard]] std::string example_stream();

/// One small stream per feature of the format, and one per kind of damage.
[[nodiscard]] std::vector<GoldenCase> golden_cases();

/// The same of version 3: weights, and no noise.
[[nodiscard]] std::vector<GoldenCase> golden_cases_3();

/// The same of version 4: switches of the schedule.
[[nodiscard]] std::vector<GoldenCase> golden_cases_4();

}  // namespace stipple
