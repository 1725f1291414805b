#pragma once

#include <filesystem>

namespace stipple {

/// The checkout that is tested.
[[nodiscard]] std::filesystem::path source_folder();

/// The folder that it was built in, with the programs.
[[nodiscard]] std::filesystem::path build_folder();

}  // namespace stipple
