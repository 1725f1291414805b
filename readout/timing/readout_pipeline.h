#pragma once

#include <cstdint>
#include <limits>

#include "readout/timing/readout_timing.h"

namespace stipple {

/// A step of the readout of a row.
struct ReadoutCommand {
    enum class Kind : std::uint8_t { kSelect, kConvert, kTransfer };
    Kind kind = Kind::kSelect;
    int row = 0;
    int count = 0;  ///< kConvert: conversions of the busiest ADC; kTransfer: columns of the
                    ///< busiest channel
};

/// The columns, ADCs and link of a sensor, without a clock: the cycle is an argument. A caller asks
/// for the earliest cycle of a command and issues it then or later. An earlier command is refused,
/// so no row, ADC or link is used twice at once.
///
/// Rows rise within a slot; each is selected, converted, transferred. A conversion goes to one of
/// two row latches (one with kSequential), so row i + 2 waits until row i is transferred. Blanking
/// follows each conversion and each transfer; with kSequential, each row.
class ReadoutPipeline {
  public:
    static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

    /// `timing` must outlive this.
    explicit ReadoutPipeline(const ReadoutTiming& timing) : timing_(timing) {}

    /// Begins the readout of a slot with its overhead, whose rows take `full_row_clocks` each.
    /// Precondition: the readout before has ended by `cycle`; 0 <= settle.
    void begin_slot(std::int64_t cycle, std::int64_t full_row_clocks, int settle) noexcept;

    /// The first cycle at which `command` can be issued; `kNever` if other commands come first.
    [[nodiscard]] std::int64_t earliest_cycle(const ReadoutCommand& command) const noexcept;

    /// Begins `command` at `cycle`. False and no effect if that is before `earliest_cycle`.
    [[nodiscard]] bool issue(const ReadoutCommand& command, std::int64_t cycle) noexcept;

    /// End of the readout of the rows so far. The last row takes a whole row time like the others:
    /// at least the time of its conversion, except with kSequential.
    /// Precondition: all of them are transferred.
    [[nodiscard]] std::int64_t end_cycle() const noexcept;

    /// Clocks that `command` takes when issued now.
    [[nodiscard]] std::int64_t clocks(const ReadoutCommand& command) const noexcept;

  private:
    /// State of a row. Cycles are the ends of the issued steps.
    struct Row {
        int row = 0;
        bool selected = false;
        bool converted = false;
        bool transferred = false;
        std::int64_t select_end = 0;
        std::int64_t convert_clocks = 0;  ///< from its selection, without skipped rows
        std::int64_t convert_end = 0;
        std::int64_t transfer_begin = 0;
        std::int64_t transfer_end = 0;
    };
    [[nodiscard]] bool is_sequential() const noexcept {
        return timing_.row_timing == RowTiming::kSequential;
    }
    [[nodiscard]] std::int64_t earliest_select(int row) const noexcept;
    [[nodiscard]] std::int64_t earliest_transfer(int row) const noexcept;

    const ReadoutTiming& timing_;
    int settle_ = 0;
    std::int64_t begin_ = 0;
    std::int64_t first_select_ = 0;    ///< not before
    std::int64_t first_transfer_ = 0;  ///< not before
    std::int64_t link_free_ = 0;       ///< since the last transfer
    bool any_row_ = false;
    Row newest_;  ///< the row that was selected last
    Row older_;   ///< the one before
};

}  // namespace stipple
