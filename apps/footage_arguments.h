#pragma once

#include <optional>
#include <string>

#include "core/footage_reader.h"

namespace CLI {
class App;
}

namespace stipple {

/// `--transfer` and `--luminance`.
void add_footage_arguments(CLI::App& command, FootageOptions& options);

/// `--max-value V`: positive and finite.
void add_max_value(CLI::App& command, std::optional<double>& max_value);

/// \throws InputError for a recording if any of these options was given: its numbers are linear.
void check_recording_options(const std::string& recording, const FootageOptions& options);

}  // namespace stipple
