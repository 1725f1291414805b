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

/// The columns, ADCs and link of a sensor, without a clock of their own: the cycle is an argument.
/// Whoever drives them asks when a command is possible and issues it then or later; what is not
/// possible is refused, so that no row, ADC or link is ever used twice at once.
///
/// Rows rise within a slot; each is selected, converted, transferred. A conversion goes to one of
/// two row latches (one, where conversion and transfer take turns), so row i + 2 waits until row i
/// is transferred. Blanking follows each conversion and each transfer; where they take turns,
/// each row.
class ReadoutPipeline {
  public:
    static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

    /// `timing` must outlive this.
    explicit ReadoutPipeline(const ReadoutTiming& timing) : timing_(timing) {}

    /// Begins the readout of a slot: overhead first, whose rows take `full_row_clocks` each.
    /// Precondition: the readout before has ended by `cycle`; 0 <= settle.
    void begin_slot(std::int64_t cycle, std::int64_t full_row_clocks, int settle) noexcept;

    /// The first cycle at which `command` can be issued; `kNever` if other commands come first.
    [[nodiscard]] std::int64_t earliest_cycle(const ReadoutCommand& command) const noexcept;

    /// Begins `command` at `cycle`. False and no effect if that is before `earliest_cycle`.
    [[nodiscard]] bool issue(const ReadoutCommand& command, std::int64_t cycle) noexcept;

    /// When the rows that were read so far are done. The last one takes a whole row time, as in
    /// between: as long as its conversion at least, unless they take turns.
    /// Precondition: all of them are transferred.
    [[nodiscard]] std::int64_t end_cycle() const noexcept;

    /// Clocks that `command` takes when issued now.
    [[nodiscard]] std::int64_t clocks(const ReadoutCommand& command) const noexcept;

  private:
    /// What a row has gone through. Cycles are the ends of the steps that were issued.
    struct Row {
        int row = 0;
        bool selected = false;
        bool converted = false;
        bool transferred = false;
        std::int64_t select_end = 0;
        std::int64_t convert_clocks = 0;  ///< from its selection, stepping over rows aside
        std::int64_t convert_end = 0;
        std::int64_t transfer_begin = 0;
        std::int64_t transfer_end = 0;
    };
    [[nodiscard]] bool takes_turns() const noexcept {
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
