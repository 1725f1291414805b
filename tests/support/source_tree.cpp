// The only source that is compiled anew in another checkout: ccache serves the others.
#include "tests/support/source_tree.h"

namespace stipple {

std::filesystem::path source_folder() {
    return STIPPLE_SOURCE_DIR;
}

std::filesystem::path build_folder() {
    return STIPPLE_BINARY_DIR;
}

}  // namespace stipple
