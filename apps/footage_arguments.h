#pragma once

#include <optional>

#include "core/footage_reader.h"

namespace CLI {
class App;
}

namespace stipple {

/// `--transfer` and `--luminance`.
void add_footage_arguments(CLI::App& command, FootageOptions& options);

/// `--max-value V`: positive and finite.
void add_max_value(CLI::App& command, std::optional<double>& max_value);

}  // namespace stipple
