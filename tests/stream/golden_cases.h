#pragma once

#include <string>
#include <vector>

namespace stipple {

/// A file of tests/golden/stream.
struct GoldenCase {
    std::string name;
    std::string bytes;
};

/// The stream of the example in docs/stream_format.md.
[[nodiscard]] std::string example_stream();

/// One small stream per feature of the format, and one per kind of damage.
[[nodiscard]] std::vector<GoldenCase> golden_cases();

/// The same of version 3: weights, and no noise.
[[nodiscard]] std::vector<GoldenCase> golden_cases_3();

}  // namespace stipple
