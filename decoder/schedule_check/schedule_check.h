#pragma once

#include <cstddef>
#include <optional>

#include "decoder/schedule_check/schedule_shift.h"
#include "stream/stream_reader.h"

namespace stipple {

/// Whether the samples of a recording follow the schedule that its header states.
struct ScheduleCheck {
    enum class Verdict {
        kAgrees,      ///< they do
        kShifted,     ///< they follow it with a shift
        kCannotTell,  ///< too dark, flat or short, or a schedule whose shifts look alike
        kNoneFits,    ///< the header's does not fit, and no shift does that was tried
    };
    Verdict verdict = Verdict::kCannotTell;
    ScheduleShift shift;  ///< the best; each number as small as may be, so rather -1 than 14
    /// Mean disagreement of neighbouring samples, 0..1 (ScheduleResidual): with the header's
    /// schedule, nothing if the numbers of samples contradict it; with the best shift; and the
    /// median of all shifts that are possible.
    std::optional<double> header_residual;
    std::optional<double> best_residual;
    std::optional<double> median_residual;
    std::size_t tried = 0;     ///< shifts
    std::size_t possible = 0;  ///< of these, by the numbers of samples
};

/// Finds the shift of the header's schedule that its samples follow, by trying all: every slot of
/// the period, all rows and columns of a tile up to 33, of a larger one up to 16 to each side. It
/// reads 24 slots, from the first on that no exposure begun before slot 0 would be read in. Shifts
/// that contradict the numbers of samples are out; of the others the residual decides, if the best
/// lies a tenth below the median and five standard errors below the header's.
/// The reader stands at its beginning, with ReadPolicy::kAnySchedule. The same result for any
/// number of threads.
[[nodiscard]] ScheduleCheck check_schedule(StreamReader& reader);

}  // namespace stipple
