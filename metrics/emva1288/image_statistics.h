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

  private:
    std::vector<std::uint64_t> sum_;  ///< of each pixel
    std::vector<double> means_;       ///< of each image
    double sum_of_squares_ = 0;       ///< of all values
};

}  // namespace stipple::emva1288
