#pragma once

#include <cstdlib>
#include <filesystem>

#include "tests/support/source_tree.h"

namespace stipple {

/// The folder of real footage: $STIPPLE_FOOTAGE, or shared/footage beside the project. It may be
/// absent.
inline std::filesystem::path footage_folder() {
    const char* folder = std::getenv("STIPPLE_FOOTAGE");
    return folder != nullptr ? std::filesystem::path(folder)
                             : source_folder() / "../shared/footage";
}

}  // namespace stipple
