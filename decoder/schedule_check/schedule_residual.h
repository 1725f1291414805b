#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "decoder/pixel_response.h"
#include "decoder/schedule_check/schedule_shift.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// Disagreement of neighbouring samples under a schedule. The light per slot, y / n, of a sample is
/// compared with that of the last samples to its left and above it:
///
///     |a - b| / (|a| + |b| + 3 sqrt(var a + var b))
///
/// lies in 0..1. It is small only if both exposures have the lengths of the schedule and the pixels
/// are neighbours. The noise in the denominator reduces the influence of dark samples. The residual
/// is the mean over all pairs, each weighted by the part of its light in the denominator. Saturated
/// samples are not used.
struct ScheduleResidual {
    static constexpr std::size_t kParts = 16;  ///< of the array in scan order, for their spread

    std::array<double, kParts> sum{};
    std::array<double, kParts> weight{};

    /// Nothing if there is no pair.
    [[nodiscard]] std::optional<double> mean() const;
};

/// Difference of the residuals of `worse` and `better` in standard errors, from the spread of the
/// difference over the parts; 0 if they are equal everywhere.
[[nodiscard]] double standard_errors_between(const ScheduleResidual& better,
                                             const ScheduleResidual& worse);

/// Evaluates schedules on some rows of some packets.
class ResidualMeter {
  public:
    /// `header` and `packets` must outlive it; packets by slot and row, without gaps.
    ResidualMeter(const StreamHeader& header, std::span<const SamplePacket> packets);

    /// Residual of the header's schedule with a shift (normalised as for visit_due_shifted), on
    /// about `rows` rows, in bands all over the array. Uses plane 0 only; pixels of a mosaic are
    /// compared with the nearest pixels of their colour. Precondition: `fits(shift)`.
    [[nodiscard]] ScheduleResidual residual(const ScheduleShift& shift, int rows) const;

    /// True if each packet has the number of samples that are due, including exposures that began
    /// before slot 0.
    [[nodiscard]] bool fits(const ScheduleShift& shift) const;

  private:
    struct Rate {
        float light = 0;     ///< per slot
        float variance = 0;  ///< of `light`
        std::int64_t slot = -1000;
    };
    [[nodiscard]] Rate rate_of(int row, int col, std::uint16_t dn, int slots) const;
    /// Adds the pair of a sample and an earlier one.
    static void add_pair(const Rate& a, const Rate& b, std::size_t part, ScheduleResidual& result);
    [[nodiscard]] std::size_t planes() const {
        return static_cast<std::size_t>(header_.shape.planes);
    }

    const StreamHeader& header_;
    std::span<const SamplePacket> packets_;
    PixelResponses responses_;
};

}  // namespace stipple
