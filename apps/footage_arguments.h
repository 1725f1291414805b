#pragma once

#include <optional>
#include <string>

#include "apps/command_line.h"
#include "io/footage_reader.h"

namespace stipple {

/// `--transfer`, of the footage that its help names, and `--luminance`.
void add_footage_arguments(Command& command, FootageOptions& options,
                           const std::string& footage = "the footage");

/// `--max-value V`: positive and finite.
void add_max_value(Command& command, std::optional<double>& max_value);

/// \throws InputError for a recording if any of these options was given: its numbers are linear.
void check_recording_options(const std::string& recording, const FootageOptions& options);

}  // namespace stipple
