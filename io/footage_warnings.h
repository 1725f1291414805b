#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/footage_reader.h"
#include "io/image.h"

namespace stipple {

/// Effects of `options` on numbers of this kind that users may not expect; each begins with `name`.
[[nodiscard]] std::vector<std::string> reading_warnings(const SourceTraits& traits,
                                                        const FootageOptions& options,
                                                        const std::string& name);

/// A warning if the mean of `light` is far above 1.0, as with digital numbers stored in floating
/// point; else empty.
[[nodiscard]] std::string brightness_warning(std::span<const float> light,
                                             const std::string& where);

}  // namespace stipple
