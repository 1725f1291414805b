#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "readout/timing/readout_cost.h"
#include "readout/timing/readout_rate.h"

namespace stipple {

/// Readout cost of a recording, for programs: the key `readout` of `emulate` in docs/outputs.md.
/// `light_throughput` is that of schedule and filters.
[[nodiscard]] nlohmann::ordered_json readout_json(const ReadoutCost& cost, double light_throughput);

/// The same in a few lines for people.
[[nodiscard]] std::string readout_text(const ReadoutCost& cost);

/// How fast a sensor reads, for programs: the keys of `timing` in docs/outputs.md.
[[nodiscard]] nlohmann::ordered_json rate_json(const ReadoutRate& rate, const ReadoutCost& cost);

/// The same as a table for people.
[[nodiscard]] std::string rate_text(const ReadoutRate& rate, const ReadoutCost& cost);

}  // namespace stipple
