#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/pending_output.h"
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

/// Slots [first, first + slots).
struct SlotRange {
    std::int64_t first = 0;
    std::int64_t slots = 0;
};

/// A VCD file of the readout (waveform.h). Its name is reserved by the constructor, before the
/// work, so that an unusable name is an error at once.
class WaveformFile {
  public:
    /// \throws InputError as PendingOutput.
    WaveformFile(const std::string& file, bool force) : output_(file, force) {}

    /// Writes the slots of `range`, of which the first begins at time 0, as long as `keep_going`
    /// returns true. `sensor` is the name of the scope in the file. Adds these slots to `cost`.
    /// Precondition: nothing was added to it yet.
    /// \throws DeviceError.
    void write(ReadoutCost& cost, const std::string& sensor, SlotRange range,
               const std::function<bool()>& keep_going);

  private:
    PendingOutput output_;
};

}  // namespace stipple
