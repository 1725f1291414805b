#include "capture/clipping.h"

#include <fmt/format.h>

#include <algorithm>

namespace stipple {

std::string clipping_text(const std::string& name, std::span<const float> light,
                          const PixelFormat& format) {
    const auto clipped = std::ranges::count_if(light, [](float value) { return value > 1; });
    if (clipped == 0) return {};
    return fmt::format(
        "{}: its first frame has light up to {:.3g}; {:.2g} % of it is clipped to 1.0, the most "
        "that {} holds, in steps of 1/{}",
        name, *std::ranges::max_element(light),
        100.0 * static_cast<double>(clipped) / static_cast<double>(light.size()), format.name,
        (1 << format.significant_bits) - 1);
}

}  // namespace stipple
