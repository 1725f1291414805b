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

/// How many pixels of each row are due in each slot, of a schedule whose tile is the whole array
/// and whose exposures have no gaps: all that a reader of such a stream checks, in two bytes a row
/// and slot of the period where the schedule itself takes 20 bytes an exposure.
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
    std::vector<std::uint16_t> absent_;  ///< by slot and row: of these, begun before slot 0
};

/// True if `samples` samples are due in these rows of `slot`: planes x `count_due`, but counted by
/// tiles, and no further than `samples`, so that a false claim costs no more than a true one.
[[nodiscard]] bool matches_schedule(const StreamHeader& stream, std::int64_t slot, RowBand band,
                                    std::size_t samples);

/// The same by the counts of a schedule that has `planes` samples a pixel.
[[nodiscard]] bool matches_counts(const DueCounts& counts, std::int64_t slot, RowBand band,
                                  std::size_t planes, std::size_t samples);

}  // namespace stipple
