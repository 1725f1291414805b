#pragma once

#include <string>
#include <vector>

#include "core/config.h"

namespace stipple {

/// Keys that `--set` can change together, of one `section` ("sensor").
struct KeyList {
    std::string section;
    std::string of;  ///< mode of the sensor or "timing", kind of schedule, method
    std::vector<KnownKey> keys;
};

/// The lists that `--set` takes keys of, but those of cameras. Empty names stand for all.
/// \throws UsageError with the known names for an unknown `of`.
[[nodiscard]] std::vector<KeyList> key_lists(const std::string& section, const std::string& of);

}  // namespace stipple
