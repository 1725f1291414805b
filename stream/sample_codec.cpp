#include "stream/sample_codec.h"

#include "stream/bit_packing.h"
#include "stream/crc32c.h"
#include "stream/packet_codec.h"
#include "stream/packet_order.h"

namespace stipple {

std::vector<std::uint8_t> encode_samples(const SamplePacket& packet, int bit_depth,
                                         std::uint32_t seed, std::uint16_t switches) {
    PacketHeader header;
    header.switches = switches;
    header.flags = packet.flags;
    header.slot = static_cast<std::uint64_t>(packet.slot);
    header.first_row = static_cast<std::uint16_t>(packet.first_row);
    header.rows = static_cast<std::uint16_t>(packet.rows);
    header.samples = static_cast<std::uint32_t>(packet.dn.size());
    std::vector<std::uint8_t> bytes(kPacketHeaderBytes + packed_bytes(packet.dn.size(), bit_depth));
    pack_bits(packet.dn, bit_depth, std::span(bytes).subspan(kPacketHeaderBytes));
    frame_packet(header, bytes, seed);
    return bytes;
}

DecodedSamples decode_samples(const StreamHeader& stream, const Framing& framing,
                              std::span<const std::uint8_t> bytes, StreamPosition expected) {
    DecodedSamples decoded;
    const auto fail = [&](std::string fault) {
        decoded.fault = std::move(fault);
        return decoded;
    };
    if (start_of(bytes, framing) != Start::kPacket) return fail("no packet begins here");
    const PacketHeader header = decode_packet_header(bytes);
    if (header.kind != PacketKind::kSamples) return fail("it is not a packet of samples");
    if (header.payload_bytes > bytes.size() - kPacketHeaderBytes)
        return fail("a packet is longer than what there is");
    const auto payload = bytes.subspan(kPacketHeaderBytes, header.payload_bytes);
    if (crc32c(payload) != header.payload_crc) return fail("samples are damaged (CRC mismatch)");
    if (const auto fault = sample_fault(stream, header, payload, expected))
        return fail(fault->text);
    SamplePacket& packet = decoded.packet;
    packet.slot = static_cast<std::int64_t>(header.slot);
    packet.first_row = header.first_row;
    packet.rows = header.rows;
    packet.flags = header.flags;
    packet.dn.resize(header.samples);
    unpack_bits(payload, stream.calibration.bit_depth, packet.dn);
    decoded.bytes = kPacketHeaderBytes + payload.size();
    return decoded;
}

}  // namespace stipple
