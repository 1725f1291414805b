#pragma once

#include <filesystem>
#include <string>

namespace stipple {

/// A file or folder of the project that a test reads, by its name there.
[[nodiscard]] std::filesystem::path project_path(const std::filesystem::path& name);

/// A program of this build that a test runs.
[[nodiscard]] std::filesystem::path built_program(const std::string& name);

}  // namespace stipple
