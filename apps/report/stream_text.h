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

/// True if nothing is lost of what the writer of the stream has put into it, as far as one can see.
[[nodiscard]] bool undamaged(const StreamReport& report);

/// What is lost of a damaged stream: the first places with offset, bytes and cause, the number of
/// the others, and the slots that are missing.
[[nodiscard]] std::string damage_text(const StreamReport& report);

}  // namespace stipple
