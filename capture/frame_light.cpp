#include "capture/frame_light.h"

#include <fmt/format.h>

#include <cassert>
#include <cstddef>

#include "core/error.h"
#include "io/pixel_unpack.h"

namespace stipple {

FrameLight::FrameLight(const FrameLayout& layout, double black_level_dn)
    : layout_(layout), shape_{layout.height, layout.width, layout.format->planes} {
    const double full_scale = (1 << layout.format->significant_bits) - 1;
    if (!(black_level_dn >= 0 && black_level_dn < full_scale))
        throw InputError("black level", fmt::format("{} DN is outside 0..{} of {}", black_level_dn,
                                                    full_scale, layout.format->name));
    light_of_dn_ = light_table(*layout.format, black_level_dn, full_scale);
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
