#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "io/pending_output.h"
#include "readout/timing/readout_cost.h"

namespace stipple {

struct SlotRange {
    std::int64_t first = 0;
    std::int64_t slots = 0;
};

/// A VCD file of the readout. Made before the work, so that a name that cannot be used is refused
/// at once.
class WaveformFile {
  public:
    /// \throws InputError as PendingOutput.
    WaveformFile(const std::string& file, bool force) : output_(file, force) {}

    /// Writes the slots of `range`, of which the first begins at time 0, while `goes_on`.
    /// \throws DeviceError.
    void write(ReadoutCost& cost, const std::string& sensor, SlotRange range,
               const std::function<bool()>& goes_on);

  private:
    PendingOutput output_;
};

}  // namespace stipple
