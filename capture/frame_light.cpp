#include "capture/frame_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "core/error.h"
#include "io/pixel_format.h"

namespace stipple {

void unpack_frame(const FrameLayout& layout, std::span<const std::uint8_t> payload,
                  std::vector<std::uint16_t>& samples) {
    const PixelFormat& format = *layout.format;
    const auto row_samples =
        static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(format.planes);
    const auto rows = static_cast<std::size_t>(layout.height);
    const std::size_t row_bytes = format.row_bytes(layout.width);
    samples.resize(row_samples * rows);
    std::vector<std::uint8_t> cut;
    for (std::size_t row = 0; row < rows; ++row) {
        std::span<const std::uint8_t> bytes =
            payload.subspan(std::min(payload.size(), row * layout.stride_bytes));
        if (bytes.size() < row_bytes) {
            cut.assign(bytes.begin(), bytes.end());
            cut.resize(row_bytes);
            bytes = cut;
        }
        unpack_row(format, bytes.first(row_bytes),
                   std::span(samples).subspan(row * row_samples, row_samples));
    }
}

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
