#pragma once

#include <filesystem>
#include <vector>

namespace stipple {

/// Where files lie that belong to this code: the folder of the shared library that the code is in,
/// if it is in one (the Python module), then that of the program.
[[nodiscard]] std::vector<std::filesystem::path> own_folders();

/// Whether `folder` is `above` or below it. An installed copy must not look for files where it was
/// built: on another machine that folder may be anybody's.
[[nodiscard]] bool lies_in(const std::filesystem::path& folder, const std::filesystem::path& above);

}  // namespace stipple
