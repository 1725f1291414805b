#pragma once

#include <vector>

namespace stipple::emva1288 {

/// A number for each pixel, by row and column.
struct PixelMap {
    int rows = 0;
    int cols = 0;
    std::vector<double> values;
};

/// Rows and columns of the window of `high_pass`.
inline constexpr int kHighPassSize = 5;

/// Each pixel minus the mean of the 5 x 5 pixels around it (EMVA 1288 release 3.1, annex C.5). Only
/// the pixels whose window lies inside the map: 4 rows and columns less, none of a smaller map.
[[nodiscard]] PixelMap high_pass(const PixelMap& map);

/// Variance of a map without its shading: the mean of (high_pass - its mean)^2, divided by 24 / 25,
/// the factor by which the filter lowers the variance of white noise. NaN if the map is smaller
/// than 5 x 5.
[[nodiscard]] double high_pass_variance(const PixelMap& map);

}  // namespace stipple::emva1288
