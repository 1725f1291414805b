#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/demo_trial.h"

namespace stipple {

/// The result of one way to record and decode a scene.
struct TrialResult {
    std::string name;
    std::string schedule;
    std::string text;  ///< description
    StreamSize size;
    VideoQuality quality;
};

/// For programs: an array with an entry per result.
[[nodiscard]] nlohmann::ordered_json trials_json(const std::vector<TrialResult>& results);

/// For people: a table with a line per result. Precondition: there is a result.
[[nodiscard]] std::string trials_table(const std::vector<TrialResult>& results);

}  // namespace stipple
