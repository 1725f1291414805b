#include "core/light.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/error.h"
#include "core/hdr_curves.h"

namespace stipple {
namespace {

bool is_light(float value) {
    return value >= 0.0F && value <= std::numeric_limits<float>::max();
}

/// Electro-optical transfer function of IEC 61966-2-1.
float srgb_to_light(float value) {
    if (value <= 0.04045F) return value / 12.92F;
    return std::pow((value + 0.055F) / 1.055F, 2.4F);
}

template <typename Curve>
void apply(std::span<float> values, Curve curve) {
    for (float& value : values) value = value > 0.0F ? curve(value) : value;
}

}  // namespace

FrameShape checked_shape(std::uint64_t rows, std::uint64_t cols, std::uint64_t planes,
                         std::string_view where) {
    if (planes != 1 && planes != 3)
        throw InputError(where, fmt::format("has {} planes; give mono (1) or RGB (3)", planes));
    if (rows < 1 || rows > kMaxFrameSide || cols < 1 || cols > kMaxFrameSide ||
        rows * cols * planes > kMaxFrameSites)
        throw InputError(where, fmt::format("a frame of {} rows and {} columns is outside 1..{} "
                                            "a side and {} values in all",
                                            rows, cols, kMaxFrameSide, kMaxFrameSites));
    return {static_cast<int>(rows), static_cast<int>(cols), static_cast<int>(planes)};
}

void check_packed(std::uint64_t bytes, std::uint64_t file_bytes, std::string_view where,
                  std::uint64_t ratio) {
    if (bytes / ratio / 2 > file_bytes)
        throw InputError(where, fmt::format("announces an image of {} bytes, but the file holds "
                                            "{}; it is damaged or ends too early",
                                            bytes, file_bytes));
}

void linearise(std::span<float> values, Transfer transfer) {
    switch (transfer) {
        case Transfer::kGamma22:
            return apply(values, [](float value) { return std::pow(value, 2.2F); });
        case Transfer::kSrgb:
            for (float& value : values) value = srgb_to_light(value);
            return;
        case Transfer::kBt709:
            return apply(values, bt709_light);
        case Transfer::kPq: {
            constexpr auto kWhite = static_cast<float>(kReferenceWhiteCd);
            return apply(values, [](float value) { return pq_luminance(value) / kWhite; });
        }
        case Transfer::kHlg: {
            const auto white = static_cast<float>(hlg_light_of_luminance(kReferenceWhiteCd));
            return apply(values, [white](float value) { return hlg_light(value) / white; });
        }
        case Transfer::kLinear:
            return;
        case Transfer::kAuto:
            assert(false);
    }
}

void check_light(std::span<const float> light, FrameShape shape, std::string_view where,
                 bool negative) {
    const auto is_good = [negative](float value) {
        return is_light(negative ? std::abs(value) : value);
    };
    bool good = true;
    for (const float value : light) good &= is_good(value);
    if (good) return;
    std::size_t site = 0;
    while (is_good(light[site])) ++site;
    const auto width = static_cast<std::size_t>(shape.cols);
    const std::size_t pixel = site % shape.pixels();
    const char* problem = std::isnan(light[site])   ? "light is not a number"
                          : std::isinf(light[site]) ? "light is infinite"
                                                    : "light is negative";
    const Message remedy = std::isfinite(light[site])
                               ? "clip it with " + Parameter{"min_value", "0"}
                               : Message("repair the footage first");
    throw InputError(
        where, fmt::format("row {}, column {}, plane {}: {} ({}); ", pixel / width, pixel % width,
                           site / shape.pixels(), problem, light[site]) +
                   remedy);
}

void scale_light(std::span<float> light, double factor, std::string_view where) {
    const auto scale = static_cast<float>(factor);
    bool finite = true;
    for (float& value : light) {
        value *= scale;
        finite &= value <= std::numeric_limits<float>::max();
    }
    if (!finite)
        throw InputError(where, "light becomes infinite by " +
                                    Parameter{"scale", fmt::to_string(factor)} +
                                    "; give a smaller factor");
}

void reduce_to_luminance(std::span<const float> rgb, std::span<float> luminance) {
    const std::size_t pixels = luminance.size();
    assert(rgb.size() == 3 * pixels);
    const float* red = rgb.data();
    const float* green = red + pixels;
    const float* blue = green + pixels;
    for (std::size_t i = 0; i < pixels; ++i)
        luminance[i] = 0.2126F * red[i] + 0.7152F * green[i] + 0.0722F * blue[i];
}

}  // namespace stipple
