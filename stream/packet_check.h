#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "stream/packet_codec.h"
#include "stream/packet_order.h"
#include "stream/stream_header.h"

namespace stipple {

/// What is wrong with a packet of kind 1 whose CRCs are good, if anything. No packet may begin
/// before `expected`. With `any_schedule` it may hold any number of samples up to one a site.
[[nodiscard]] std::optional<std::string> sample_fault(const StreamHeader& stream,
                                                      const PacketHeader& packet,
                                                      std::span<const std::uint8_t> payload,
                                                      StreamPosition expected,
                                                      bool any_schedule = false);

/// The same for an index packet, whose entries must lie before `offset`. `expected`: see above.
[[nodiscard]] std::optional<std::string> index_fault(const PacketHeader& packet,
                                                     std::span<const std::uint8_t> payload,
                                                     std::uint64_t offset, StreamPosition expected);

}  // namespace stipple
