#pragma once

#include <filesystem>
#include <string>

namespace stipple {

// Partial outputs of killed runs: their process has ended.

/// Warns on standard error if a killed run has left a partial `output`.
void say_leftover(const std::filesystem::path& output);

/// "; " and a remark that the run of a partial output still writes it, or was killed. Empty for
/// other files.
[[nodiscard]] std::string leftover_text(const std::filesystem::path& file);

}  // namespace stipple
