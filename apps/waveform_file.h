#pragma once

#include <cstdint>
#include <string>

#include "io/pending_output.h"
#include "readout/timing/readout_account.h"

namespace stipple {

/// A VCD file of the readout. Made before the work, so that a name that cannot be used is refused
/// at once.
class WaveformFile {
  public:
    /// \throws InputError as PendingOutput.
    WaveformFile(const std::string& file, bool force) : output_(file, force) {}

    /// Writes `slots` slots from `first_slot` on, of which the first begins at time 0.
    /// \throws DeviceError.
    void write(ReadoutAccount& account, const std::string& sensor, std::int64_t first_slot,
               std::int64_t slots);

  private:
    PendingOutput output_;
};

}  // namespace stipple
