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

/// How badly samples agree with their neighbours under some schedule. Light per slot, y / n, of a
/// sample is compared with that of the samples last read to its left and above it:
///
///     |a - b| / (|a| + |b| + 3 sqrt(var a + var b))
///
/// lies in 0..1 and is small only if both exposures are as long as the schedule says and the pixels
/// are neighbours; the noise in the denominator keeps the dark from deciding. The residual is the
/// mean over all pairs, each weighted with the part of its light in the denominator. Saturated
/// samples are in no pair.
struct ScheduleResidual {
    static constexpr std::size_t kParts = 16;  ///< of the array in scan order, for their spread

    std::array<double, kParts> sum{};
    std::array<double, kParts> weight{};

    /// Nothing if there is no pair.
    [[nodiscard]] std::optional<double> mean() const;
};

/// By how many standard errors `worse` has the larger residual, by the spread of the difference
/// over the parts; 0 if they are equal everywhere.
[[nodiscard]] double standard_errors_between(const ScheduleResidual& better,
                                             const ScheduleResidual& worse);

/// Evaluates schedules on some rows of some packets.
class ResidualMeter {
  public:
    /// `header` and `packets` must outlive it; packets by slot and row, one stretch of a recording.
    ResidualMeter(const StreamHeader& header, std::span<const SamplePacket> packets);

    /// Of the header's schedule with a shift (normalised as for visit_due_shifted), on
    /// about `rows` rows, in bands all over the array. Only plane 0; a mosaic's pixels are compared
    /// with the next of their colour. Preconditions: `fits(shift)`.
    [[nodiscard]] ScheduleResidual residual(const ScheduleShift& shift, int rows) const;

    /// True if each packet holds as many samples as are due, exposures that began before slot 0
    /// included.
    [[nodiscard]] bool fits(const ScheduleShift& shift) const;

  private:
    struct Rate {
        float light = 0;     ///< per slot
        float variance = 0;  ///< of `light`
        std::int64_t slot = -1000;
    };
    [[nodiscard]] Rate rate_of(int row, int col, std::uint16_t dn, int slots) const;
    /// Of a sample just read and an earlier one.
    static void add_pair(const Rate& a, const Rate& b, std::size_t part, ScheduleResidual& result);
    [[nodiscard]] std::size_t planes() const {
        return static_cast<std::size_t>(header_.shape.planes);
    }

    const StreamHeader& header_;
    std::span<const SamplePacket> packets_;
    PixelResponses responses_;
};

}  // namespace stipple
