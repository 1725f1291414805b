#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// What the readout of each slot of a stream costs.
class StreamLoads {
  public:
    /// `header` must outlive this.
    explicit StreamLoads(const StreamHeader& header) : header_(header) {}

    /// Memory grows with the slot of the packet.
    void add(const SamplePacket& packet);
    /// 1 + the last slot.
    [[nodiscard]] std::int64_t slots() const { return static_cast<std::int64_t>(flags_.size()); }

    /// By slot `samples` (in the stream), `due` (by the schedule), `payload_bits`, `overrun` and
    /// `dropped`; `full_bits`, the bits of a slot in which every pixel is read. If the provenance
    /// tells the clocks of the sensor also `clocks` (`readout_json`), else null.
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    const StreamHeader& header_;
    std::vector<std::uint64_t> samples_;
    std::vector<std::uint8_t> flags_;
};

/// The clocks of the readout of slots [0, slots): `clock_hz`, `slot_clocks` (the time there is) and
/// by slot `readout`, `convert`, `link`, `link_bits`, `limit`. Null if the provenance does not tell
/// the timing of the sensor.
[[nodiscard]] nlohmann::ordered_json readout_json(const StreamHeader& header, std::int64_t slots);

}  // namespace stipple
