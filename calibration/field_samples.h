#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "decoder/pixel_response.h"
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

}  // namespace stipple
