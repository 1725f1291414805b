#pragma once

#include <cstdint>
#include <vector>

namespace stipple::emva1288 {

/// How far pixels are from their mean, for logarithmic charts of defects (EMVA 1288 release 3.1,
/// section 8.4). The unit is that of the values. No bins: there are no values.
struct DeviationHistogram {
    double first = 0;  ///< centre of the first bin
    double width = 0;  ///< of a bin
    std::vector<std::int64_t> pixels;
    /// Pixels of each bin, if all of them were normal with the standard deviation of the values.
    std::vector<double> normal;
    double accumulated_width = 0;
    std::vector<std::int64_t> at_least;  ///< [q]: pixels with abs(deviation) >= q accumulated_width
};

/// Of at most 256 bins, whose width is a multiple of `step`, the distance of values that can be.
/// Precondition: step > 0.
[[nodiscard]] DeviationHistogram deviation_histogram(std::vector<double> values, double step);

}  // namespace stipple::emva1288
