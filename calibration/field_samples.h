#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "decoder/pixel_response.h"
#include "decoder/response_curve.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// Sums of the means of a row over the frames in which all of its pixels were read.
struct RowSums {
    double frames = 0;
    double mean = 0;            ///< in DN
    double square_of_mean = 0;  ///< in DN^2
};

/// Sums of the samples of each site at one exposure time; order (plane, row, col).
struct ExposureSums {
    std::vector<std::uint32_t> count;
    std::vector<std::uint64_t> sum;             ///< of DN
    std::vector<std::uint64_t> sum_of_squares;  ///< of DN
    std::vector<RowSums> rows;                  ///< order (plane, row)
    std::uint64_t samples = 0;                  ///< of all sites
    std::uint64_t saturated = 0;                ///< of these, only a lower bound (PixelResponse)
    std::uint64_t zeros = 0;                    ///< of these, DN 0

    /// Mean DN of a site. Precondition: it has a sample.
    [[nodiscard]] double mean(std::size_t site) const {
        return static_cast<double>(sum[site]) / count[site];
    }
    /// Unbiased variance between the samples of a site. Precondition: it has two samples.
    [[nodiscard]] double variance(std::size_t site) const;
    /// Variance of the errors that the means of the sites of a row have in common, as row noise
    /// makes them: of the mean of a row, beyond that of independent sites; mean over the rows of a
    /// plane. 0 if no row was read whole in two frames.
    [[nodiscard]] double row_error(int plane, FrameShape shape) const;
};

/// The samples of a chip in a constant, uniform field, or in the dark, by exposure time. Sums of
/// sites are exact, so their order has no influence.
class FieldSamples {
  public:
    /// An array of this shape.
    explicit FieldSamples(FrameShape shape) : shape_(shape) {}

    [[nodiscard]] FrameShape shape() const { return shape_; }
    /// By exposure time in nanoseconds: open slots x length of a slot.
    [[nodiscard]] const std::map<std::int64_t, ExposureSums>& exposures() const {
        return exposures_;
    }
    /// Samples of a site at all exposure times.
    [[nodiscard]] std::uint64_t count(std::size_t site) const;
    /// Those of the site that has the fewest.
    [[nodiscard]] std::uint64_t fewest() const;

  private:
    friend class FieldCollector;
    [[nodiscard]] ExposureSums& at(std::int64_t exposure_ns);

    FrameShape shape_;
    std::map<std::int64_t, ExposureSums> exposures_;
};

/// Adds the packets of one stream, or the images of one exposure time, to the samples of a field.
class FieldCollector {
  public:
    /// `header` and `field` must outlive this. Precondition: header.shape == field.shape().
    FieldCollector(const StreamHeader& header, FieldSamples& field);

    void add(const SamplePacket& packet);

  private:
    void add_row(int row, std::span<const std::uint16_t> dn, ExposureSums& sums) const;

    const StreamHeader& header_;
    FieldSamples& field_;
    SiteResponses responses_;
    std::vector<ExposureSums*> by_open_slots_;  ///< null: not yet met
};

/// The groups of sites that see the same light: the planes, or the colours of a mosaic.
inline constexpr std::size_t kMaxLightGroups = 4;

[[nodiscard]] std::size_t light_group(const StreamHeader& header, std::size_t site);

/// The samples of one exposure time, with their noise; in linear DN, if there is a curve.
struct FieldExposure {
    double seconds = 0;
    const ExposureSums* sums = nullptr;
    const ResponseCurve* curve = nullptr;  ///< null: the chip is linear
    /// Temporal variance of a sample, mean over the sites of a group, in DN^2; at least 1 / 12,
    /// because the rounding errors of a sample without noise are the same in all frames.
    std::array<double, kMaxLightGroups> noise_dn2{};
    std::vector<double> row_error_dn2 = {};  ///< by plane, ExposureSums::row_error

    [[nodiscard]] bool has(std::size_t site) const { return sums->count[site] > 0; }
    /// Mean sample of a site. Precondition: has(site).
    [[nodiscard]] double mean(std::size_t site) const;
    /// Temporal variance of the samples of a site. Precondition: it has two.
    [[nodiscard]] double variance(std::size_t site) const;
    /// Variance of the mean of a site's samples: noise / number of samples. A site with more than
    /// four times the noise of its group has its own. Precondition: has(site).
    [[nodiscard]] double mean_variance(std::size_t site, std::size_t group) const;
    /// The same of a site with the noise of its group and the mean number of samples.
    [[nodiscard]] double usual_variance(std::size_t group) const {
        return noise_dn2[group] * static_cast<double>(sums->count.size()) /
               static_cast<double>(sums->samples);
    }
};

/// `sums` must outlive the result.
[[nodiscard]] FieldExposure field_exposure(std::int64_t exposure_ns, const ExposureSums& sums,
                                           const StreamHeader& header);

/// The same exposure in the linear DN of `curve`, which must outlive the result; null: in DN.
[[nodiscard]] FieldExposure linearised(FieldExposure exposure, const StreamHeader& header,
                                       const ResponseCurve* curve);

}  // namespace stipple
