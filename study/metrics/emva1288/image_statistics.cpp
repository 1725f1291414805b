#include "study/metrics/emva1288/image_statistics.h"

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

std::vector<double> ImageStack::mean_image() const {
    const auto images = static_cast<double>(means_.size());
    std::vector<double> mean;
    for (const std::uint64_t sum : sum_) mean.push_back(static_cast<double>(sum) / images);
    return mean;
}

SpatialVariances ImageStack::spatial_variances(int cols) const {
    const auto columns = static_cast<std::size_t>(cols);
    const std::size_t rows = sum_.size() / columns;
    assert(rows >= 3 && columns >= 3 && rows * columns == sum_.size());
    const auto images = static_cast<double>(means_.size());
    const auto m = static_cast<double>(rows), n = static_cast<double>(columns);
    std::vector<double> row_means(rows), column_means(columns);
    for (std::size_t i = 0; i < sum_.size(); ++i) {
        const double pixel = static_cast<double>(sum_[i]) / images;
        row_means[i / columns] += pixel / n;
        column_means[i % columns] += pixel / m;
    }
    const ImageStatistics all = statistics();
    const double temporal = all.temporal_variance_dn2 / images;
    const double row = scatter(row_means) / (m - 1) - temporal / n;
    const double column = scatter(column_means) / (n - 1) - temporal / m;
    const double single = m * n * (all.spatial_variance_dn2 - row - column) / (m * n - m - n);
    return {.row_dn2 = row - single / n, .column_dn2 = column - single / m, .pixel_dn2 = single};
}

}  // namespace stipple::emva1288
