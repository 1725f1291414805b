#pragma once

#include <filesystem>

namespace stipple {

/// The folder of real footage: $STIPPLE_FOOTAGE, or shared/footage beside the project. It may be
/// absent.
[[nodiscard]] std::filesystem::path footage_folder();

}  // namespace stipple
