#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "stream/due_count.h"
#include "stream/packet_codec.h"
#include "stream/packet_order.h"
#include "stream/stream_header.h"

namespace stipple {

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

/// The same for an index packet. The offsets of its entries must be less than `offset`.
[[nodiscard]] std::optional<std::string> index_fault(const PacketHeader& packet,
                                                     std::span<const std::uint8_t> payload,
                                                     std::uint64_t offset, StreamPosition expected);

}  // namespace stipple
