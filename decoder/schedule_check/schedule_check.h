#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "decoder/pixel_response.h"
#include "decoder/schedule_check/schedule_shift.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"
#include "stream/stream_reader.h"

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

/// Whether the samples of a stream follow the schedule in its header.
struct ScheduleCheck {
    enum class Verdict {
        kAgrees,      ///< they follow it
        kShifted,     ///< they follow it with a shift
        kCannotTell,  ///< too dark, flat or short, or a schedule whose shifts look alike
        kNoneFits,    ///< neither the header's schedule nor a tested shift of it fits
    };
    Verdict verdict = Verdict::kCannotTell;
    ScheduleShift shift;  ///< the best one; numbers of minimum size, such as -1 instead of 14
    /// Mean disagreement of neighbouring samples, 0..1 (ScheduleResidual): with the header's
    /// schedule (nothing if the numbers of samples contradict it); with the best shift; median of
    /// all possible shifts.
    std::optional<double> header_residual;
    std::optional<double> best_residual;
    std::optional<double> median_residual;
    std::size_t tried = 0;     ///< shifts
    std::size_t possible = 0;  ///< shifts that the numbers of samples do not contradict
};

/// Finds the shift of the header's schedule that the samples follow, by testing all shifts: every
/// slot of the period, all rows and columns of a tile up to 33, up to 16 to each side of a larger
/// tile. It reads 24 slots, beginning after the end of all exposures that began before slot 0.
/// Shifts that contradict the numbers of samples are excluded. The best of the others is taken if
/// its residual is at most 0.9 of the median and five standard errors below all shifts that do not
/// look the same. The reader stands at its beginning, with ReadPolicy::kAnySchedule. The same
/// result for any number of threads. \throws InputError if exposures are weighted.
[[nodiscard]] ScheduleCheck check_schedule(StreamReader& reader);

}  // namespace stipple
