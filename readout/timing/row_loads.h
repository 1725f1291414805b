#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "readout/timing/readout_timing.h"

namespace stipple {

/// Load of a row in a slot.
struct RowLoad {
    int row = 0;              ///< dark rows are below 0
    int due = 0;              ///< pixels with samples in the stream
    int columns = 0;          ///< transferred: due columns, or all columns of their groups
    int channel_columns = 0;  ///< of the busiest channel
    int conversions = 1;      ///< of the busiest ADC

    bool operator==(const RowLoad&) const = default;
};

/// \throws InputError if the window `shape` is empty or larger than the array.
void check_window(const ReadoutTiming& timing, FrameShape shape);

/// The load of a row whose first `cols` columns are all read.
[[nodiscard]] RowLoad full_row(const ReadoutTiming& timing, int cols);

/// Loads of the rows by a schedule, with the column addressing of a sensor.
class RowLoads {
  public:
    /// `shape`: the window that is read. `timing` and `schedule` must outlive this.
    /// \throws InputError as `check_window`.
    RowLoads(const ReadoutTiming& timing, const ExposureSchedule& schedule, FrameShape shape);

    /// Fills `loads` with the rows that are read at the end of `slot`, in scan order; dark rows
    /// first, if any row is read. Run time grows with the due pixels.
    void list(std::int64_t slot, std::vector<RowLoad>& loads);

    /// True if pixels of the row, or of others of its groups, are due at the end of `slot`.
    [[nodiscard]] bool is_due(std::int64_t slot, int row) const;
    /// Slots until such a row is due again, and the samples that its pixels keep must be read.
    /// Precondition: is_due(slot, row).
    [[nodiscard]] int due_again_slots(std::int64_t slot, int row) const;

    /// The columns that each channel transfers of `row` at the end of `slot`; for waveforms.
    [[nodiscard]] std::span<const int> channel_columns(std::int64_t slot, int row);

  private:
    void mark_block(std::int64_t slot, int first_row);
    [[nodiscard]] RowLoad count_marked();

    const ReadoutTiming& timing_;
    const ExposureSchedule& schedule_;
    FrameShape shape_;
    int block_rows_;                       ///< rows with the same transferred columns
    bool count_adcs_;                      ///< true if shared ADCs skip columns
    std::vector<std::uint16_t> channel_;   ///< of each column
    std::vector<std::uint16_t> adc_;       ///< of each column, if ADCs skip
    std::vector<std::uint16_t> marked_;    ///< first columns of the transferred groups of a block
    std::vector<std::uint8_t> is_marked_;  ///< by group
    std::vector<int> due_;                 ///< by row of the block
    std::vector<int> by_channel_;
    std::vector<int> by_adc_;
};

}  // namespace stipple
