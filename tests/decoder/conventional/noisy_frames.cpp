#include "tests/decoder/conventional/noisy_frames.h"

#include <algorithm>
#include <cmath>

#include "tests/decoder/recordings.h"

namespace stipple {

DeliveredFrames noisy_frames(const FluxVideo& truth, FrameNoise noise, std::uint32_t seed) {
    constexpr std::size_t kSummands = 12;  // whose sum has the variance 1
    const auto random = random_values(kSummands * truth.voxels(), -0.5F, 0.5F, seed);
    DeliveredFrames frames{truth, noise};
    for (std::size_t i = 0; i < truth.voxels(); ++i) {
        float normal = 0;
        for (std::size_t k = 0; k < kSummands; ++k) normal += random[kSummands * i + k];
        frames.light.data()[i] += std::sqrt(noise.variance(truth.data()[i])) * normal;
    }
    return frames;
}

namespace {

template <typename Light>
FluxVideo painted(int frames, FrameShape shape, const Light& light) {
    FluxVideo video(frames, shape);
    for (int frame = 0; frame < frames; ++frame)
        for (int plane = 0; plane < shape.planes; ++plane)
            for (int row = 0; row < shape.rows; ++row)
                for (int col = 0; col < shape.cols; ++col)
                    video.plane(frame, plane)(row, col) = light(frame, plane, row, col);
    return video;
}

}  // namespace

FluxVideo moving_texture(int frames, FrameShape shape, float cols) {
    return painted(frames, shape, [&](int frame, int plane, int row, int col) {
        const float x = static_cast<float>(col) - cols * static_cast<float>(frame);
        const auto y = static_cast<float>(row);
        return 0.5F + (0.2F - 0.05F * static_cast<float>(plane)) * std::sin(0.31F * x + 0.11F * y) +
               0.2F * std::sin(0.23F * y - 0.17F * x);
    });
}

FluxVideo moving_edge(int frames, FrameShape shape, float cols) {
    return painted(frames, shape, [&](int frame, int, int, int col) {
        const float edge = 20 + cols * static_cast<float>(frame);
        return 0.2F + 0.4F * std::clamp(static_cast<float>(col + 1) - edge, 0.0F, 1.0F);
    });
}

double error_of(const FluxVideo& a, const FluxVideo& truth, int frame, int margin) {
    double sum = 0;
    int count = 0;
    for (int plane = 0; plane < truth.shape().planes; ++plane)
        for (int row = margin; row < truth.shape().rows - margin; ++row)
            for (int col = margin; col < truth.shape().cols - margin; ++col, ++count) {
                const double d = static_cast<double>(a.plane(frame, plane)(row, col)) -
                                 static_cast<double>(truth.plane(frame, plane)(row, col));
                sum += d * d;
            }
    return sum / count;
}

}  // namespace stipple
