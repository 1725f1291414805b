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

/// How many samples a packet must hold: those that are due by the schedule of the stream.
struct DueRule {
    bool any = false;                   ///< any number up to one a site instead
    const DueCounts* counts = nullptr;  ///< by these instead
};

/// What is wrong with a packet of kind 1 whose CRCs are good, if anything. No packet may begin
/// before `expected`.
[[nodiscard]] std::optional<std::string> sample_fault(const StreamHeader& stream,
                                                      const PacketHeader& packet,
                                                      std::span<const std::uint8_t> payload,
                                                      StreamPosition expected,
                                                      const DueRule& rule = {});

/// The same for an index packet, whose entries must lie before `offset`. `expected`: see above.
[[nodiscard]] std::optional<std::string> index_fault(const PacketHeader& packet,
                                                     std::span<const std::uint8_t> payload,
                                                     std::uint64_t offset, StreamPosition expected);

}  // namespace stipple
