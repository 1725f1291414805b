#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace stipple::emva1288 {

/// Mean and noise of one exposure, in DN.
struct ImageStatistics {
    double mean_dn = 0;
    double temporal_variance_dn2 = 0;  ///< between images, mean over pixels
    double spatial_variance_dn2 = 0;   ///< between the means of pixels, minus the temporal part
};

/// The spatial variance of an exposure, split into parts of rows, of columns and of single pixels
/// (EMVA 1288 release 4.0). The part of the pixels is low by row / M + column / N, as the standard
/// defines it.
struct SpatialVariances {
    double row_dn2 = 0;
    double column_dn2 = 0;
    double pixel_dn2 = 0;
};

/// Accumulates images of one exposure; sums are exact, so their order has no influence.
class ImageStack {
  public:
    /// Precondition: the number of values of the first image, at most 2^16 images.
    void add(std::span<const std::uint16_t> dn);

    /// With L images of N pixels, y_l the mean of image l, m the mean image:
    ///
    ///     temporal = (mean over pixels of the variance between images) - variance of the y_l
    ///     spatial  = variance of m - temporal / L
    ///
    /// Both variances are unbiased. For a pair the temporal one is sum (a - b)^2 / 2N - (y_a -
    /// y_b)^2 / 2, as in EMVA 1288: fluctuations of the lamp are not counted as noise.
    /// Precondition: at least two images.
    [[nodiscard]] ImageStatistics statistics() const;

    /// The mean of each pixel over the images, in DN. Precondition: at least one image.
    [[nodiscard]] std::vector<double> mean_image() const;

    /// With M rows and N columns, s^2 the spatial variance of `statistics`, r and c the variances
    /// of the row means and of the column means of m, minus temporal / L N and temporal / L M:
    ///
    ///     pixel  = M N (s^2 - r - c) / (M N - M - N)
    ///     row    = r - pixel / N
    ///     column = c - pixel / M
    ///
    /// Each may be negative, by its statistical error. Precondition: as `statistics`; `cols`
    /// divides the number of values; at least three rows and columns.
    [[nodiscard]] SpatialVariances spatial_variances(int cols) const;

  private:
    std::vector<std::uint64_t> sum_;  ///< of each pixel
    std::vector<double> means_;       ///< of each image
    double sum_of_squares_ = 0;       ///< of all values
};

}  // namespace stipple::emva1288
