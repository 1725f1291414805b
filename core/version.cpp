#include "core/version.h"

namespace stipple {

const char* version() noexcept {
    return STIPPLE_VERSION;
}

}  // namespace stipple
