#include "core/homography.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace stipple {
namespace {

/// Of H: each entry is a difference of two products.
Homography::Matrix adjugate(const Homography::Matrix& m) {
    const auto [a, b, c, d, e, f, g, h, i] = m;
    return {e * i - f * h, c * h - b * i, b * f - c * e, f * g - d * i, a * i - c * g,
            c * d - a * f, d * h - e * g, b * g - a * h, a * e - b * d};
}

double determinant(const Homography::Matrix& m) {
    const Homography::Matrix adj = adjugate(m);
    return m[0] * adj[0] + m[1] * adj[3] + m[2] * adj[6];
}

/// Product of the largest entries of the rows: what a determinant is small against.
double size_of(const Homography::Matrix& m) {
    double size = 1;
    for (std::size_t row = 0; row < m.size(); row += 3)
        size *= std::max({std::abs(m[row]), std::abs(m[row + 1]), std::abs(m[row + 2])});
    return size;
}

}  // namespace

bool Homography::is_singular() const {
    constexpr double kRounding = 1e-12;
    return !(std::abs(determinant(h_)) > kRounding * size_of(h_));  // also for NaN
}

bool Homography::is_finite_on(FrameShape shape) const {
    const auto w = [&](int row, int col) { return h_[6] * col + h_[7] * row + h_[8]; };
    const double corners[] = {w(0, 0), w(0, shape.cols - 1), w(shape.rows - 1, 0),
                              w(shape.rows - 1, shape.cols - 1)};
    const auto [least, greatest] = std::minmax_element(std::begin(corners), std::end(corners));
    return *least > 0 || *greatest < 0;
}

Homography Homography::inverse() const {
    const double det = determinant(h_);
    Matrix inverse = adjugate(h_);
    for (double& entry : inverse) entry /= det;
    return Homography(inverse);
}

std::int64_t nearest_pixel(FrameShape shape, FramePoint place) {
    const double row = std::floor(place.row + 0.5);
    const double col = std::floor(place.col + 0.5);
    const bool inside = row >= 0 && row < shape.rows && col >= 0 && col < shape.cols;
    if (!inside) return -1;
    return static_cast<std::int64_t>(row) * shape.cols + static_cast<std::int64_t>(col);
}

std::uint64_t overlap_pixels(const Homography& map, FrameShape shape) {
    std::uint64_t count = 0;
    for (int row = 0; row < shape.rows; ++row)
        for (int col = 0; col < shape.cols; ++col)
            if (nearest_pixel(shape, map({static_cast<double>(row), static_cast<double>(col)})) >=
                0)
                ++count;
    return count;
}

}  // namespace stipple
