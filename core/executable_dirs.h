#pragma once

#include <filesystem>
#include <vector>

namespace stipple {

/// Where files lie that belong to this code: the folder of the shared library that the code is in,
/// if it is in one (the Python module), then that of the program. The folder in which the code was
/// built is none of them: on another machine it may be anybody's.
[[nodiscard]] std::vector<std::filesystem::path> executable_dirs();

}  // namespace stipple
