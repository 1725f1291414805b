#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/decode_file.h"
#include "decoder/schedule_check/schedule_check.h"

namespace stipple {

/// Finds out whether a stream follows the schedule in its header, and says so. `reader` as for
/// check_schedule. \throws InputError if it follows another one, unless that is a shift that the
/// arguments want to be decoded with; if the stream cannot be read a second time.
[[nodiscard]] ScheduleCheck checked_schedule(StreamReader& reader, const DecodeArguments& arguments,
                                             const RunOptions& run);

/// The JSON key `schedule_check`.
[[nodiscard]] nlohmann::ordered_json check_json(const ScheduleCheck& check);

}  // namespace stipple
