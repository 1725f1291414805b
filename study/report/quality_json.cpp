#include "study/report/quality_metrics.h"

#include <nlohmann/json.hpp>

namespace stipple {

nlohmann::ordered_json quality_json(const VideoQuality& quality) {
    return metrics_json(chosen_metrics({}), quality);
}

}  // namespace stipple
