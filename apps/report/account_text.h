#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "readout/timing/readout_account.h"
#include "readout/timing/readout_rate.h"

namespace stipple {

/// Readout cost of a recording, for programs: the key `readout` of `emulate` in docs/cli.md.
/// `light_throughput` is that of schedule and filters.
[[nodiscard]] nlohmann::ordered_json account_json(const ReadoutAccount& account,
                                                  double light_throughput);

/// The same in a few lines for people.
[[nodiscard]] std::string account_text(const ReadoutAccount& account);

/// How fast a sensor reads, for programs: the keys of `timing` in docs/cli.md.
[[nodiscard]] nlohmann::ordered_json rate_json(const ReadoutRate& rate,
                                               const ReadoutAccount& account);

/// The same as a table for people.
[[nodiscard]] std::string rate_text(const ReadoutRate& rate, const ReadoutAccount& account);

}  // namespace stipple
