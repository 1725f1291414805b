#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "stream/due_count.h"
#include "stream/packet_codec.h"
#include "stream/stream_header.h"

namespace stipple {

/// A row of a slot. Sample packets come by slot, then by row.
struct StreamPosition {
    std::int64_t slot = 0;
    int row = 0;
    auto operator<=>(const StreamPosition&) const = default;
};

/// Follows the sample packets of a stream and finds gaps between them.
class PacketOrder {
  public:
    explicit PacketOrder(int array_rows) : array_rows_(array_rows) {}

    /// The slots before `slot` are left out, and not missing. Precondition: nothing came yet.
    void begin_at(std::int64_t slot) {
        expected_ = {slot, 0};
        counted_ = slot;
    }
    /// Where the next packet begins if nothing is missing.
    [[nodiscard]] StreamPosition expected() const { return expected_; }
    /// Advances to `next` and counts slots with missing rows.
    /// Precondition: next >= expected().
    void skip_to(StreamPosition next);
    /// Advances by `rows` rows of a slot. Precondition: the slot has them.
    void advance(int rows);

    /// Slots with missing rows.
    [[nodiscard]] std::int64_t missing_slots() const { return missing_slots_; }
    /// The gap that `skip_to(next)` would skip: "slot 3 from row 4 to slot 5 row 7 is missing".
    [[nodiscard]] std::string missing_before(StreamPosition next) const;

  private:
    int array_rows_;
    StreamPosition expected_;
    std::int64_t missing_slots_ = 0;
    std::int64_t counted_ = 0;  ///< slots below are counted if they miss rows
};

/// Rule for the number of samples of a packet; by default the due pixels of the schedule x planes.
struct DueRule {
    bool any = false;                   ///< any number up to one per site
    const DueCounts* counts = nullptr;  ///< these counts instead of the schedule
};

/// What is wrong with a packet whose CRCs are correct.
struct PacketFault {
    std::string text;
    /// Its number of samples is not that of the due pixels: the chip may have run another schedule.
    bool is_unexpected = false;
};

/// The fault of a packet of kind 1 with correct CRCs; nothing if it is good. The packet must not
/// begin before `expected`.
[[nodiscard]] std::optional<PacketFault> sample_fault(const StreamHeader& stream,
                                                      const PacketHeader& packet,
                                                      std::span<const std::uint8_t> payload,
                                                      StreamPosition expected,
                                                      const DueRule& rule = {});

/// The same for a switch packet that is no copy of the last one, before its payload is decoded.
[[nodiscard]] std::optional<std::string> switch_fault(const StreamHeader& stream,
                                                      const PacketHeader& packet,
                                                      StreamPosition expected);

/// Of a stream of an earlier version than 4.
inline constexpr int kNoSwitches = -1;

/// The same for an index packet. The offsets of its entries must be less than `offset`; `switches`:
/// number of the last one that came, or kNoSwitches.
[[nodiscard]] std::optional<std::string> index_fault(const PacketHeader& packet,
                                                     std::span<const std::uint8_t> payload,
                                                     std::uint64_t offset, StreamPosition expected,
                                                     int switches);

}  // namespace stipple
