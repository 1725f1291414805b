#pragma once

#include <cstdlib>
#include <filesystem>

namespace stipple {

/// The folder of real footage: $STIPPLE_FOOTAGE, or shared/footage beside the project. It may be
/// absent.
inline std::filesystem::path footage_folder() {
    const char* folder = std::getenv("STIPPLE_FOOTAGE");
    return folder != nullptr ? std::filesystem::path(folder)
                             : std::filesystem::path(STIPPLE_SOURCE_DIR) / "../shared/footage";
}

}  // namespace stipple
