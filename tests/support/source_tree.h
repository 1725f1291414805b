#pragma once

#include <filesystem>
#include <string>

namespace stipple {

/// A file or folder of the project that a test reads, by its name there. Where scripts/run_tests is
/// to run the test again when it changes, READS in the test's CMakeLists.txt lists it. \throws
/// std::logic_error if ctest runs the test and READS does not hold it.
[[nodiscard]] std::filesystem::path project_path(const std::filesystem::path& name);

/// A program of this build that a test runs; the same for READS.
[[nodiscard]] std::filesystem::path built_program(const std::string& name);

}  // namespace stipple
