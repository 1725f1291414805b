#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stream/stream_header.h"

namespace stipple {

struct RowBand {
    int first_row = 0;
    int rows = 0;
};

/// Number of due pixels in each row and slot, for a schedule whose tile is the whole array and
/// whose exposures have no gaps. Enough to check the packets of a stream, in two bytes per row and
/// slot of the period; the schedule itself needs 20 bytes per exposure.
class DueCounts {
  public:
    DueCounts(int rows, int period_slots);
    /// Precondition: no pixel is added twice.
    void add(int row, std::span<const Exposure> of_pixel);
    [[nodiscard]] std::size_t due(std::int64_t slot, int row) const;

  private:
    int rows_;
    int period_slots_;
    std::vector<std::uint16_t> steady_;  ///< by phase and row
    std::vector<std::uint16_t> absent_;  ///< by slot and row: due, but begun before slot 0
};

/// True if `samples` equals the due pixels of these rows of `slot` x planes. Counts by tiles and
/// stops above `samples`, so a false number costs no more time than a true one.
[[nodiscard]] bool matches_schedule(const StreamHeader& stream, std::int64_t slot, RowBand band,
                                    std::size_t samples);

/// The same by the counts of a schedule that has `planes` samples a pixel.
[[nodiscard]] bool matches_counts(const DueCounts& counts, std::int64_t slot, RowBand band,
                                  std::size_t planes, std::size_t samples);

}  // namespace stipple
