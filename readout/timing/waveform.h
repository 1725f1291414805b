#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "readout/timing/readout_cost.h"
#include "readout/timing/readout_timing.h"
#include "readout/timing/slot_readout.h"

namespace stipple {

/// The readout as a value change dump (VCD, IEEE 1364) for a waveform viewer. Times are in ps,
/// rounded; the vector `cycle` holds the exact clock.
///
/// Signals: slot_start (the first clock of a slot), slot, overrun, code_load; row_select (a row is
/// on the column lines) and row, adc_busy; link_valid and link_row, columns (of that row),
/// channel_busy (a bit per channel). Dark rows have numbers below 0.
class Waveform {
  public:
    /// `timing` must outlive this.
    Waveform(const ReadoutTiming& timing, std::string_view sensor);

    /// Declarations and initial values: the beginning of the file.
    [[nodiscard]] std::string head() const;
    /// A save file of GTKWave for the waveform `file`: the signals in groups, rows as signed
    /// numbers.
    [[nodiscard]] std::string view(std::string_view file) const;
    /// Adds the next slot of `cost`, the same in all calls; the changes before it.
    [[nodiscard]] std::string add_slot(ReadoutCost& cost);
    /// The changes up to the end of the last slot, at clock `end`, and of its scan.
    [[nodiscard]] std::string tail(std::int64_t end);

  private:
    enum Signal : std::uint8_t {
        kCycle,
        kSlotStart,
        kSlot,
        kOverrun,
        kCodeLoad,
        kRowSelect,
        kRow,
        kAdcBusy,
        kLinkValid,
        kLinkRow,
        kColumns,
        kChannelBusy,
        kSignals
    };
    struct Change {
        std::int64_t cycle;
        Signal signal;
        std::string value;
    };
    void set(std::int64_t cycle, Signal signal, std::int64_t value);
    void set_channels(std::int64_t cycle, const std::vector<bool>& busy);
    void add_row(const RowTimes& row, std::span<const int> channel_columns);
    [[nodiscard]] std::string take_until(std::int64_t cycle);
    [[nodiscard]] int bits_of(Signal signal) const;

    const ReadoutTiming& timing_;
    std::string sensor_;
    std::vector<Change> changes_;   ///< not yet taken
    std::vector<std::string> now_;  ///< last values, by signal
};

}  // namespace stipple
