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
    /// `header` is that of a reader with ReadPolicy::kCounts, and outlives this. To know how long
    /// slots are, a random schedule is made, if it takes no more than `max_bytes` of memory.
    StretchedSlots(const StreamHeader& header, std::uint64_t max_bytes);
    ~StretchedSlots();
    StretchedSlots(const StretchedSlots&) = delete;
    StretchedSlots& operator=(const StretchedSlots&) = delete;

    void add(const SamplePacket& packet);

    [[nodiscard]] std::int64_t slots() const { return slots_; }
    /// Their mean; nothing without such slots, or if they cannot be known.
    [[nodiscard]] std::optional<double> mean_us() const;

  private:
    struct Readout;
    void set_up();

    const StreamHeader& header_;
    std::uint64_t max_bytes_;
    std::unique_ptr<Readout> readout_;  ///< null if the timing is not known, or not yet
    std::int64_t slots_ = 0;
    double total_us_ = 0;
};

}  // namespace stipple
