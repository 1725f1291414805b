#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/exposure_schedule.h"
#include "decoder/pixel_response.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"
#include "stream/stream_reader.h"

namespace stipple {

/// Shift of a schedule relative to its samples: pixel (row, col) in slot t follows the schedule of
/// pixel (row + rows, col + cols) in slot t + slots. Each number is taken modulo the period or the
/// tile.
struct ScheduleShift {
    int slots = 0;
    int rows = 0;
    int cols = 0;

    bool operator==(const ScheduleShift&) const = default;
};

/// The schedule of a chip that runs `schedule` with this shift.
[[nodiscard]] ExposureSchedule shifted_schedule(const ExposureSchedule& schedule,
                                                const ScheduleShift& shift);

/// One row of the array at the end of a slot.
struct RowInSlot {
    std::int64_t slot = 0;
    int row = 0;
    int cols = 0;
};

/// `visit_due_pixels` of the shifted schedule, without creating it. Precondition: 0 <= shift.slots
/// < period, 0 <= shift.rows, 0 <= shift.cols < tile columns.
template <typename Visit>
void visit_due_shifted(const ExposureSchedule& schedule, const ScheduleShift& shift,
                       const RowInSlot& at, Visit&& visit) {
    const auto phase = static_cast<int>((at.slot + shift.slots) % schedule.period_slots());
    const auto due = schedule.due(phase, (at.row + shift.rows) % schedule.tile_rows());
    const auto split = std::ranges::partition_point(
        due, [&](const DuePixel& pixel) { return pixel.col < shift.cols; });
    const auto visit_part = [&](auto begin, auto end, int tile_col) {
        for (auto pixel = begin; pixel != end; ++pixel) {
            const int col = tile_col + pixel->col;
            if (col >= at.cols) return;
            if (pixel->span_slots <= at.slot + 1) visit(col, *pixel);
        }
    };
    for (int tile_col = -shift.cols; tile_col < at.cols; tile_col += schedule.tile_cols()) {
        visit_part(split, due.end(), tile_col);
        visit_part(due.begin(), split, tile_col + schedule.tile_cols());
    }
}

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
/// result for any number of threads. \throws InputError if exposures are weighted, or
/// the stream is of version 4.
[[nodiscard]] ScheduleCheck check_schedule(StreamReader& reader);

}  // namespace stipple
