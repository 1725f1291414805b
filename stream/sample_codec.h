#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "stream/packet_codec.h"
#include "stream/packet_order.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// The bytes of a packet of samples, as StreamWriter writes them; `seed`: of the Framing;
/// `switches`: of the stream so far. Precondition: each DN is below 2^bit_depth.
[[nodiscard]] std::vector<std::uint8_t> encode_samples(const SamplePacket& packet, int bit_depth,
                                                       std::uint32_t seed,
                                                       std::uint16_t switches = 0);

/// A packet decoded from bytes, or the fault.
struct DecodedSamples {
    SamplePacket packet;
    std::size_t bytes = 0;  ///< length of the packet
    std::string fault;      ///< empty if the packet is good
};

/// The packet of samples at the beginning of `bytes`. It is good if its CRCs are correct, its slot
/// and row are not before `expected`, and its number of samples follows the schedule of `stream`.
[[nodiscard]] DecodedSamples decode_samples(const StreamHeader& stream, const Framing& framing,
                                            std::span<const std::uint8_t> bytes,
                                            StreamPosition expected);

}  // namespace stipple
