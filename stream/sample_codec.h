#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "stream/framing.h"
#include "stream/packet_order.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// The bytes of a packet of samples, as StreamWriter writes them; `seed`: of the Framing.
/// Precondition: each DN is below 2^bit_depth.
[[nodiscard]] std::vector<std::uint8_t> encode_samples(const SamplePacket& packet, int bit_depth,
                                                       std::uint32_t seed);

/// One packet out of bytes, or why there is none.
struct DecodedSamples {
    SamplePacket packet;
    std::size_t bytes = 0;  ///< that it fills
    std::string fault;      ///< empty if the packet is good
};

/// The packet of samples that `bytes` begin with. It is good if its CRCs are, and if it holds what
/// the schedule of `stream` says for a slot and row not before `expected`.
[[nodiscard]] DecodedSamples decode_samples(const StreamHeader& stream, const Framing& framing,
                                            std::span<const std::uint8_t> bytes,
                                            StreamPosition expected);

}  // namespace stipple
