#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "io/pending_output.h"
#include "readout/timing/readout_cost.h"

namespace stipple {

/// Slots [first, first + slots).
struct SlotRange {
    std::int64_t first = 0;
    std::int64_t slots = 0;
};

/// A waveform of the readout (waveform.h), VCD or by a name with .fst FST, and beside it a save
/// file of GTKWave, .gtkw. Both names are reserved by the constructor, before the work, so that an
/// unusable name is an error at once. FST needs the program vcd2fst.
class WaveformFile {
  public:
    /// \throws InputError as PendingOutput, DeviceError if there is no vcd2fst.
    WaveformFile(const std::filesystem::path& file, bool force);

    /// Writes the slots of `range`, of which the first begins at time 0, as long as `keep_going`
    /// returns true. `sensor` is the name of the scope in the file. Adds these slots to `cost`.
    /// Precondition: nothing was added to it yet.
    /// \throws DeviceError.
    void write(ReadoutCost& cost, const std::string& sensor, SlotRange range,
               const std::function<bool()>& keep_going);

  private:
    PendingOutput output_;
    PendingOutput view_;
    std::optional<PendingOutput> vcd_;  ///< of an FST file, never put in place
};

}  // namespace stipple
