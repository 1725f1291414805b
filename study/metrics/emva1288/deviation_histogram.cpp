#include "study/metrics/emva1288/deviation_histogram.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace stipple::emva1288 {
namespace {

constexpr std::int64_t kMaxBins = 256;
constexpr double kSqrt2Pi = 2.50662827463100050242;
constexpr double kRounding = 1e-6;  ///< of a bin: values on its edge belong to it

/// Steps in a bin, so that a range of so many steps has at most 256 bins.
std::int64_t steps_in_bin(double range, double step) {
    return std::llround(range / step) / kMaxBins + 1;
}

std::size_t bin_of(double distance, double width) {
    return static_cast<std::size_t>(distance / width + kRounding);
}

std::vector<std::int64_t> counts(const std::vector<double>& values, double first, double width) {
    const double last = *std::ranges::max_element(values);
    std::vector<std::int64_t> bins(bin_of(last - first, width) + 1);
    for (const double value : values) ++bins[bin_of(value - first, width)];
    return bins;
}

std::vector<double> normal_counts(const DeviationHistogram& histogram, double pixels,
                                  double deviation) {
    std::vector<double> normal;
    for (std::size_t bin = 0; bin < histogram.pixels.size(); ++bin) {
        const double z = (histogram.first + static_cast<double>(bin) * histogram.width) / deviation;
        normal.push_back(deviation > 0 ? pixels * histogram.width / (kSqrt2Pi * deviation) *
                                             std::exp(-z * z / 2)
                                       : pixels);
    }
    return normal;
}

}  // namespace

DeviationHistogram deviation_histogram(std::vector<double> values, double step) {
    if (values.empty()) return {};
    const auto count = static_cast<double>(values.size());
    double mean = 0, squares = 0;
    for (const double value : values) mean += value / count;
    for (double& value : values) {
        value -= mean;
        squares += value * value;
    }
    const auto [min, max] = std::ranges::minmax(values);
    const auto steps = static_cast<double>(steps_in_bin(max - min, step));
    DeviationHistogram found;
    found.width = steps * step;
    found.pixels = counts(values, min, found.width);
    found.first = min + (steps - 1) / 2 * step;
    found.normal = normal_counts(found, count, std::sqrt(squares / count));
    for (double& value : values) value = std::abs(value);
    found.accumulated_width =
        static_cast<double>(steps_in_bin(*std::ranges::max_element(values), step)) * step;
    found.at_least = counts(values, 0, found.accumulated_width);
    for (std::size_t bin = found.at_least.size() - 1; bin > 0; --bin)
        found.at_least[bin - 1] += found.at_least[bin];
    return found;
}

}  // namespace stipple::emva1288
