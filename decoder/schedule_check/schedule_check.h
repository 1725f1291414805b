#pragma once

#include <cstddef>
#include <optional>

#include "decoder/schedule_check/schedule_shift.h"
#include "stream/stream_reader.h"

namespace stipple {

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
