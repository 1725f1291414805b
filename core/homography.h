#pragma once

#include <array>
#include <cstdint>

#include "core/geometry.h"

namespace stipple {

/// A place in a frame, in pixels; the centre of the first pixel is (0, 0).
struct FramePoint {
    double row = 0;
    double col = 0;

    bool operator==(const FramePoint&) const = default;
};

/// Projective map H between the frames of two sensors that see the same scene from one place:
/// (u, v, w) = H (col, row, 1) is the point (u / w, v / w) as (col, row).
class Homography {
  public:
    /// Row by row.
    using Matrix = std::array<double, 9>;
    static constexpr Matrix kIdentity{1, 0, 0, 0, 1, 0, 0, 0, 1};

    Homography() = default;
    explicit Homography(const Matrix& matrix) : h_(matrix) {}
    /// Adds `offset` to each place.
    [[nodiscard]] static Homography shift(FramePoint offset) {
        return Homography({1, 0, offset.col, 0, 1, offset.row, 0, 0, 1});
    }

    [[nodiscard]] const Matrix& matrix() const { return h_; }
    [[nodiscard]] bool is_identity() const { return h_ == kIdentity; }
    /// True if the determinant is 0, or so small that the inverse would be mostly rounding.
    [[nodiscard]] bool is_singular() const;
    /// True if no place of a frame of `shape` is mapped to infinity.
    [[nodiscard]] bool is_finite_on(FrameShape shape) const;
    /// Precondition: not singular.
    [[nodiscard]] Homography inverse() const;
    /// Precondition: the place is not mapped to infinity.
    [[nodiscard]] FramePoint operator()(FramePoint place) const {
        const auto [a, b, c, d, e, f, g, h, i] = h_;
        const double w = g * place.col + h * place.row + i;
        return {(d * place.col + e * place.row + f) / w, (a * place.col + b * place.row + c) / w};
    }

    bool operator==(const Homography&) const = default;

  private:
    Matrix h_ = kIdentity;
};

/// Row-major index of the pixel of a frame that is nearest to `place`; -1 beyond the frame.
[[nodiscard]] std::int64_t nearest_pixel(FrameShape shape, FramePoint place);

/// Number of pixels of a frame that `map` takes to pixels of a frame of the same shape.
/// Precondition: `map` is finite on it.
[[nodiscard]] std::uint64_t overlap_pixels(const Homography& map, FrameShape shape);

}  // namespace stipple
