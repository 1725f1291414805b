#include "stream/packet_codec.h"

#include <algorithm>
#include <cstring>

#include "stream/crc32c.h"
#include "stream/little_endian.h"

namespace stipple {
namespace {

using Bytes = std::span<const std::uint8_t>;
using SyncWord = std::array<std::uint8_t, 4>;

constexpr SyncWord kPacketSync{0xC5, 'S', 'P', 'K'};
constexpr SyncWord kEndSync{0xC5, 'E', 'N', 'D'};
constexpr std::size_t kHeaderCrc = 32;  ///< where it is in a packet

/// True if `bytes` begin like `sync`, as far as they go.
bool begins_like(Bytes bytes, const SyncWord& sync) {
    const auto common = static_cast<std::ptrdiff_t>(std::min(bytes.size(), sync.size()));
    return std::equal(sync.begin(), sync.begin() + common, bytes.begin());
}

/// True if the last four of `size` bytes are the CRC of those before.
bool crc_is_good(Bytes bytes, std::size_t size, std::uint32_t seed) {
    return crc32c(bytes.first(size - 4), seed) == load<std::uint32_t>(&bytes[size - 4]);
}

}  // namespace

void frame_packet(PacketHeader header, std::span<std::uint8_t> packet, std::uint32_t seed) {
    const auto payload = packet.subspan(kPacketHeaderBytes);
    std::copy(kPacketSync.begin(), kPacketSync.end(), packet.begin());
    packet[4] = static_cast<std::uint8_t>(header.kind);
    packet[5] = header.flags;
    store(&packet[6], header.switches);
    store(&packet[8], header.slot);
    store(&packet[16], header.first_row);
    store(&packet[18], header.rows);
    store(&packet[20], header.samples);
    store(&packet[24], static_cast<std::uint32_t>(payload.size()));
    store(&packet[28], crc32c(payload));
    store(&packet[kHeaderCrc], crc32c(packet.first(kHeaderCrc), seed));
}

PacketHeader decode_packet_header(Bytes bytes) {
    PacketHeader header;
    header.kind = PacketKind{bytes[4]};
    header.flags = bytes[5];
    header.switches = load<std::uint16_t>(&bytes[6]);
    header.slot = load<std::uint64_t>(&bytes[8]);
    header.first_row = load<std::uint16_t>(&bytes[16]);
    header.rows = load<std::uint16_t>(&bytes[18]);
    header.samples = load<std::uint32_t>(&bytes[20]);
    header.payload_bytes = load<std::uint32_t>(&bytes[24]);
    header.payload_crc = load<std::uint32_t>(&bytes[28]);
    return header;
}

std::uint32_t add_to_checksum(std::uint32_t checksum, Bytes packet) {
    return crc32c(packet.subspan(kHeaderCrc, 4), checksum);
}

std::array<std::uint8_t, kEndMarkerBytes> encode_end_marker(std::uint64_t index_offset,
                                                            std::uint32_t checksum,
                                                            std::uint32_t seed) {
    std::array<std::uint8_t, kEndMarkerBytes> marker{};
    std::copy(kEndSync.begin(), kEndSync.end(), marker.begin());
    store(&marker[4], index_offset);
    store(&marker[12], checksum);
    store(&marker[16], crc32c(std::span(marker).first(16), seed));
    return marker;
}

EndMarker decode_end_marker(Bytes bytes, const Framing& framing) {
    EndMarker marker{load<std::uint64_t>(&bytes[4])};
    if (framing.version != 1) marker.checksum = load<std::uint32_t>(&bytes[12]);
    return marker;
}

Start start_of(Bytes bytes, const Framing& framing) {
    if (begins_like(bytes, kPacketSync)) {
        if (bytes.size() < kPacketHeaderBytes) return Start::kCut;
        if (!crc_is_good(bytes, kPacketHeaderBytes, framing.seed)) return Start::kBadCrc;
        const bool too_large = decode_packet_header(bytes).payload_bytes > kMaxPayloadBytes;
        return too_large ? Start::kTooLarge : Start::kPacket;
    }
    if (begins_like(bytes, kEndSync)) {
        const std::size_t size = end_marker_bytes(framing);
        if (bytes.size() < size) return Start::kCut;
        return crc_is_good(bytes, size, framing.seed) ? Start::kEnd : Start::kBadCrc;
    }
    return Start::kNoSync;
}

std::size_t find_start(Bytes bytes, const Framing& framing) {
    std::size_t at = 0;
    while (at < bytes.size()) {
        const void* found = std::memchr(&bytes[at], kPacketSync[0], bytes.size() - at);
        if (found == nullptr) break;
        at = static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - bytes.data());
        const Start start = start_of(bytes.subspan(at), framing);
        if (start == Start::kPacket || start == Start::kEnd) return at;
        ++at;
    }
    return bytes.size();
}

std::string_view cause_of(Start start, const Framing& framing) {
    switch (start) {
        case Start::kBadCrc:
            return framing.version == 1
                       ? "a packet header is damaged (CRC mismatch)"
                       : "a packet header is damaged or of another stream (CRC mismatch)";
        case Start::kTooLarge:
            return "a payload is beyond 2^29 bytes";
        default:
            return "no packet begins here";
    }
}

}  // namespace stipple
