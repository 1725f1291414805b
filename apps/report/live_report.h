#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "capture/live_figures.h"

namespace stipple {

/// The keys of `capture live` in docs/outputs.md, without `preview`.
[[nodiscard]] nlohmann::ordered_json live_json(const LiveReport& report);

/// The same for people; slots are late after `late_after_slots`.
[[nodiscard]] std::string live_text(const LiveReport& report, const std::string& output,
                                    double late_after_slots);

}  // namespace stipple
