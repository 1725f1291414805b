#include "explore/enlarged_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/index.h"

namespace stipple {
namespace {

constexpr int kLobes = 3;

/// The window of Lanczos: sinc(x) sinc(x / 3).
double lanczos(double x) {
    if (x == 0) return 1;
    if (std::abs(x) >= kLobes) return 0;
    const double angle = std::numbers::pi * x;
    return kLobes * std::sin(angle) * std::sin(angle / kLobes) / (angle * angle);
}

/// Pixels of a line, and their weights.
struct Taps {
    std::array<std::size_t, 2 * kLobes> pixel;
    std::array<double, 2 * kLobes> weight;
};

/// Of each of n * count pixels.
std::vector<Taps> taps_of(int count, int n) {
    std::vector<Taps> taps;
    for (int i = 0; i < n * count; ++i) {
        const double place = (i + 0.5) / n - 0.5;
        const int first = static_cast<int>(std::floor(place)) - kLobes + 1;
        Taps of_pixel{};
        double sum = 0;
        for (int k = 0; k < 2 * kLobes; ++k) {
            of_pixel.pixel[index(k)] = index(std::clamp(first + k, 0, count - 1));
            sum += of_pixel.weight[index(k)] = lanczos(place - (first + k));
        }
        for (double& weight : of_pixel.weight) weight /= sum;
        taps.push_back(of_pixel);
    }
    return taps;
}

}  // namespace

std::vector<float> enlarged_frame(std::span<const float> frame, FrameShape shape, int n) {
    const std::vector<Taps> rows = taps_of(shape.rows, n);
    const std::vector<Taps> cols = taps_of(shape.cols, n);
    std::vector<float> enlarged;
    enlarged.reserve(rows.size() * cols.size() * index(shape.planes));
    std::vector<double> line(index(shape.cols));
    for (int plane = 0; plane < shape.planes; ++plane) {
        const auto light = frame.subspan(index(plane) * shape.pixels(), shape.pixels());
        for (const Taps& row : rows) {
            for (std::size_t col = 0; col < line.size(); ++col) {
                line[col] = 0;
                for (std::size_t k = 0; k < row.pixel.size(); ++k)
                    line[col] += row.weight[k] *
                                 static_cast<double>(light[row.pixel[k] * line.size() + col]);
            }
            for (const Taps& col : cols) {
                double sum = 0;
                for (std::size_t k = 0; k < col.pixel.size(); ++k)
                    sum += col.weight[k] * line[col.pixel[k]];
                enlarged.push_back(std::max(static_cast<float>(sum), 0.0F));
            }
        }
    }
    return enlarged;
}

}  // namespace stipple
