#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "io/pending_output.h"
#include "readout/timing/readout_cost.h"

namespace stipple {

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
