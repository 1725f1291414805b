#include "metrics/emva1288/image_statistics.h"

#include <cassert>
#include <cstddef>

namespace stipple::emva1288 {
namespace {

/// Sum of squared distances to the mean.
double scatter(const std::vector<double>& values) {
    double mean = 0, sum = 0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    for (const double value : values) sum += (value - mean) * (value - mean);
    return sum;
}

}  // namespace

void ImageStack::add(std::span<const std::uint16_t> dn) {
    if (sum_.empty()) sum_.resize(dn.size());
    assert(dn.size() == sum_.size());
    std::uint64_t sum = 0, squares = 0;
    for (std::size_t i = 0; i < dn.size(); ++i) {
        sum_[i] += dn[i];
        sum += dn[i];
        squares += std::uint64_t{dn[i]} * dn[i];
    }
    means_.push_back(static_cast<double>(sum) / static_cast<double>(dn.size()));
    sum_of_squares_ += static_cast<double>(squares);
}

ImageStatistics ImageStack::statistics() const {
    assert(means_.size() >= 2);
    const auto images = static_cast<double>(means_.size());
    const auto pixels = static_cast<double>(sum_.size());
    double mean = 0, spread = 0, between = sum_of_squares_;
    for (const double image : means_) mean += image / images;
    for (const std::uint64_t sum : sum_) {
        const double pixel = static_cast<double>(sum) / images;
        between -= pixel * pixel * images;
        spread += (pixel - mean) * (pixel - mean);
    }
    const double steadiness = scatter(means_) / (images - 1);
    const double temporal = between / (pixels * (images - 1)) - steadiness;
    return {.mean_dn = mean,
            .temporal_variance_dn2 = temporal,
            .spatial_variance_dn2 = spread / (pixels - 1) - temporal / images};
}

}  // namespace stipple::emva1288
