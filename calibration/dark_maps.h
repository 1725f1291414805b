#pragma once

#include <span>

#include "calibration/field_samples.h"
#include "calibration/shrinkage.h"
#include "stream/stream_header.h"

namespace stipple {

/// Offset and dark current of the sites of one plane, from samples y without light at exposure
/// times t: y = b + d t.
class DarkMaps {
  public:
    /// `header` and `dark` must outlive this. Precondition: every site has a sample.
    DarkMaps(const StreamHeader& header, std::span<const FieldExposure> dark, int plane);

    /// d in DN/s, by weighted least squares. Precondition: every site has two exposure times.
    [[nodiscard]] EstimateMap dark_currents() const;
    /// b in DN, the weighted mean of y - d t.
    [[nodiscard]] EstimateMap offsets(const EstimateMap& dark_currents) const;
    /// Temporal variance in DN^2 at the shortest exposure time that has two samples of a site. Its
    /// variance is that for normal noise, 2 sigma^4 / (n - 1).
    [[nodiscard]] EstimateMap readout_noise() const;

  private:
    [[nodiscard]] EstimateMap unmeasured() const;
    /// Calls visit(t, y, 1 / variance of y) for each exposure time of a pixel.
    template <typename Visit>
    void visit_means(std::size_t pixel, const Visit& visit) const;

    /// Calls visit(exposure, 1 / variance of y) for each exposure time of a usual pixel.
    template <typename Visit>
    void visit_exposures(const Visit& visit) const;
    [[nodiscard]] double row_error(const FieldExposure& exposure) const;

    const StreamHeader& header_;
    std::span<const FieldExposure> dark_;
    int plane_;
    std::size_t first_;  ///< site of the plane
};

}  // namespace stipple
