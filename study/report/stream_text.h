#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "stream/stream_reader.h"

namespace stipple {

/// Header and counts of a stream, for programs.
[[nodiscard]] nlohmann::ordered_json stream_json(const StreamHeader& header,
                                                 const StreamReport& report);

/// Which plane of colour each pixel of a 2 x 2 cell measures; null without a filter array.
[[nodiscard]] nlohmann::ordered_json filter_json(ColourFilter cfa);

/// A run as a page has it, but its `samples` and `loads`; the diagram of its schedule is of the
/// first 64 of `slots` slots.
[[nodiscard]] nlohmann::ordered_json run_json(const std::string& name, const StreamHeader& header,
                                              const StreamReport& report, std::int64_t slots);

/// Header and counts of a stream, a line each, for people.
[[nodiscard]] std::string stream_text(const StreamHeader& header, const StreamReport& report);

}  // namespace stipple
