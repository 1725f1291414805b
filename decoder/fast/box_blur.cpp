#include "decoder/fast/box_blur.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/index.h"

namespace stipple {
namespace {

constexpr int kBlurPixels = 7;
constexpr int kBlurRadius = kBlurPixels / 2;

/// mean[i] of the kBlurPixels arrays that begin at `from(0)`, `from(1)`, ...
template <typename From>
void average(std::size_t count, const From& from, float* mean) {
    std::fill_n(mean, count, 0.0F);
    for (int k = 0; k < kBlurPixels; ++k) {
        const float* array = from(k);
        for (std::size_t i = 0; i < count; ++i) mean[i] += array[i];
    }
    for (std::size_t i = 0; i < count; ++i) mean[i] /= kBlurPixels;
}

}  // namespace

void box_blur(FrameShape shape, std::span<float> plane) {
    const auto cols = index(shape.cols);
    std::vector<float> across(plane.size());
    std::vector<float> row(cols + 2 * kBlurRadius);
    for (std::size_t first = 0; first < plane.size(); first += cols) {
        const auto inside = row.begin() + kBlurRadius;
        std::fill(row.begin(), inside, plane[first]);
        std::fill(std::copy_n(&plane[first], cols, inside), row.end(), plane[first + cols - 1]);
        average(
            cols, [&](int k) { return &row[index(k)]; }, &across[first]);
    }
    for (int i = 0; i < shape.rows; ++i)
        average(
            cols,
            [&](int k) {
                return &across[index(std::clamp(i + k - kBlurRadius, 0, shape.rows - 1)) * cols];
            },
            &plane[index(i) * cols]);
}

}  // namespace stipple
