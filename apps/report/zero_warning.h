#pragma once

#include <fmt/format.h>

#include <string>

#include "stream/stream_header.h"

namespace stipple {

/// Warning that most samples of the file `name` are DN 0, where their noise is cut off; else empty.
/// Empty too for a NaN, of no samples.
[[nodiscard]] inline std::string zero_warning(const std::string& name, double zero_fraction,
                                              const Calibration& calibration) {
    if (!(zero_fraction > 0.5) || calibration.black_level_dn > 0) return {};
    return fmt::format(
        "{}: {:.2g} % of the samples are DN 0, as there is little light and no black level: their "
        "noise is cut off, and what is dark cannot be decoded exactly; give more light, or a "
        "black level (key black_level_dn of sensors in physical mode)",
        name, 100 * zero_fraction);
}

}  // namespace stipple
