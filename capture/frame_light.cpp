#include "capture/frame_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "capture/frame_unpack.h"
#include "core/error.h"

namespace stipple {

FrameLight::FrameLight(const FrameLayout& layout, double black_level_dn)
    : layout_(layout), shape_{layout.height, layout.width, layout.format->planes} {
    const double full_scale = (1 << layout.format->significant_bits) - 1;
    if (!(black_level_dn >= 0 && black_level_dn < full_scale))
        throw InputError("black level", fmt::format("{} DN is outside 0..{} of {}", black_level_dn,
                                                    full_scale, layout.format->name));
    // Devices may set bits that should be 0: a table for all that 16 bits hold.
    light_of_dn_.resize(layout.format->significant_bits == 8 ? 256 : 65536);
    for (std::size_t dn = 0; dn < light_of_dn_.size(); ++dn)
        light_of_dn_[dn] =
            static_cast<float>(std::max(0.0, static_cast<double>(dn) - black_level_dn) /
                               (full_scale - black_level_dn));
}

void FrameLight::convert(std::span<const std::uint8_t> payload, std::span<float> light) {
    assert(light.size() == shape_.sites());
    unpack_frame(layout_, payload, samples_);
    const auto planes = static_cast<std::size_t>(shape_.planes);
    const std::size_t pixels = shape_.pixels();
    for (std::size_t plane = 0; plane < planes; ++plane)
        for (std::size_t pixel = 0; pixel < pixels; ++pixel)
            light[plane * pixels + pixel] = light_of_dn_[samples_[pixel * planes + plane]];
}

}  // namespace stipple
