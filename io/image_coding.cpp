#include "io/frame_coding.h"

#include <cassert>
#include <cstring>

namespace stipple {
namespace {

template <typename Sample, typename Convert>
void interleave_as(std::span<const float> frame, FrameShape shape, std::vector<std::byte>& bytes,
                   Convert convert) {
    const auto planes = static_cast<std::size_t>(shape.planes);
    bytes.resize(shape.sites() * sizeof(Sample));
    for (std::size_t plane = 0; plane < planes; ++plane)
        for (std::size_t pixel = 0; pixel < shape.pixels(); ++pixel) {
            const Sample sample = convert(frame[plane * shape.pixels() + pixel]);
            std::memcpy(bytes.data() + (pixel * planes + plane) * sizeof(Sample), &sample,
                        sizeof(Sample));
        }
}

}  // namespace

std::uint16_t to_uint16(float light, double full_scale) {
    constexpr double kMax = 65535;
    const double dn = static_cast<double>(light) / full_scale * kMax + 0.5;
    if (!(dn > 0)) return 0;
    return static_cast<std::uint16_t>(dn < kMax ? dn : kMax);
}

void interleave(std::span<const float> frame, FrameShape shape, const ImageCoding& coding,
                std::vector<std::byte>& bytes) {
    assert(frame.size() == shape.sites() && coding.samples && *coding.samples != SampleKind::kHalf);
    if (*coding.samples == SampleKind::kFloat)
        return interleave_as<float>(frame, shape, bytes, [](float light) { return light; });
    interleave_as<std::uint16_t>(frame, shape, bytes,
                                 [&](float light) { return to_uint16(light, coding.full_scale); });
}

}  // namespace stipple
