#pragma once

#include <nlohmann/json_fwd.hpp>

#include "study/metrics/video_quality.h"

namespace stipple {

/// The figures of a comparison under the names of docs/outputs.md.
[[nodiscard]] nlohmann::ordered_json quality_json(const VideoQuality& quality);

}  // namespace stipple
