#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// Counts the slots of a stream that lasted longer than they should, as the flags of its packets
/// say, and how long they were, by the readout timing that its provenance tells.
class StretchedSlots {
  public:
    explicit StretchedSlots(const StreamHeader& header);
    ~StretchedSlots();
    StretchedSlots(const StretchedSlots&) = delete;
    StretchedSlots& operator=(const StretchedSlots&) = delete;

    void add(const SamplePacket& packet);

    [[nodiscard]] std::int64_t slots() const { return slots_; }
    /// Their mean; nothing without such slots, or if the provenance does not tell.
    [[nodiscard]] std::optional<double> mean_us() const;

  private:
    struct Readout;
    std::unique_ptr<Readout> readout_;  ///< null if the timing is not known
    std::int64_t slots_ = 0;
    double total_us_ = 0;
};

}  // namespace stipple
