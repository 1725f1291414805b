#pragma once

#include <string>
#include <vector>

namespace stipple {

/// A file of tests/golden/recording.
struct GoldenRecording {
    std::string name;
    std::string bytes;
};

/// One small recording per packing and feature of the format, and one per kind of damage.
[[nodiscard]] std::vector<GoldenRecording> golden_recordings();

}  // namespace stipple
