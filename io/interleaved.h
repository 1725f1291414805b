#pragma once

#include <cstddef>
#include <cstring>
#include <span>

namespace stipple {

/// Converts samples of interleaved channels to planes: planes[p][i] = to_float(sample p of pixel
/// i). Only the first `plane_count` channels are used, without alpha. Precondition: bytes.size() ==
/// pixels * channels * sizeof(Sample), planes.size() == pixels * plane_count, plane_count is 1 or
/// 3.
template <typename Sample, typename ToFloat>
void split_planes(std::span<const std::byte> bytes, int channels, int plane_count,
                  std::span<float> planes, ToFloat to_float) {
    const std::size_t pixels = planes.size() / static_cast<std::size_t>(plane_count);
    const std::size_t step = static_cast<std::size_t>(channels) * sizeof(Sample);
    for (int p = 0; p < plane_count; ++p) {
        const std::byte* from = bytes.data() + static_cast<std::size_t>(p) * sizeof(Sample);
        float* to = planes.data() + static_cast<std::size_t>(p) * pixels;
        for (std::size_t i = 0; i < pixels; ++i) {
            Sample sample;
            std::memcpy(&sample, from + i * step, sizeof(Sample));
            to[i] = to_float(sample);
        }
    }
}

/// Integers as fractions of their largest value.
struct UnitScale {
    float operator()(unsigned char value) const { return static_cast<float>(value) / 255.0F; }
    float operator()(unsigned short value) const { return static_cast<float>(value) / 65535.0F; }
};

}  // namespace stipple
