#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "stream/stream_reader.h"

namespace stipple {

/// Header and counts of a stream, for programs.
[[nodiscard]] nlohmann::ordered_json stream_json(const StreamHeader& header,
                                                 const StreamReport& report);

/// Header and counts of a stream, a line each, for people.
[[nodiscard]] std::string stream_text(const StreamHeader& header, const StreamReport& report);

}  // namespace stipple
