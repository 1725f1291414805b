#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/footage_reader.h"
#include "io/picture.h"

namespace stipple {

/// What `options` make of numbers of this kind that their user may not expect; `name` begins each.
[[nodiscard]] std::vector<std::string> reading_warnings(const SourceTraits& traits,
                                                        const FootageOptions& options,
                                                        const std::string& name);

/// A warning if the mean of `light` is far above 1.0, as of digital numbers stored as
/// floating-point ones; else empty.
[[nodiscard]] std::string brightness_warning(std::span<const float> light,
                                             const std::string& place);

}  // namespace stipple
