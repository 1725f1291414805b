#pragma once

#include <filesystem>
#include <vector>

namespace stipple {

/// Where files lie that belong to this code: the folder of the program, and that of the shared
/// library that the code is in, if it is in one (the Python module).
[[nodiscard]] std::vector<std::filesystem::path> own_folders();

}  // namespace stipple
