#include "stream/trailing_index.h"

#include <fmt/format.h>

#include "stream/crc32c.h"
#include "stream/packet_check.h"
#include "stream/packet_codec.h"

namespace stipple {

std::optional<std::int64_t> slots_by_index(const FileWindow& file, const Framing& framing) {
    const std::size_t marker_bytes = end_marker_bytes(framing);
    const std::uint64_t end = file.file_bytes().value_or(0);
    if (end < marker_bytes) return std::nullopt;
    const auto marker = file.read_at(end - marker_bytes, marker_bytes);
    if (!marker || start_of(*marker, framing) != Start::kEnd) return std::nullopt;
    const std::uint64_t offset = decode_end_marker(*marker, framing).index_offset;
    const auto start = file.read_at(offset, kPacketHeaderBytes);
    if (!start || start_of(*start, framing) != Start::kPacket) return std::nullopt;
    const PacketHeader packet = decode_packet_header(*start);
    const bool last = offset + kPacketHeaderBytes + packet.payload_bytes + marker_bytes == end;
    if (packet.kind != PacketKind::kIndex || !last) return std::nullopt;
    const auto payload = file.read_at(offset + kPacketHeaderBytes, packet.payload_bytes);
    if (!payload || crc32c(*payload) != packet.payload_crc) return std::nullopt;
    // Each slot takes a packet or more, so the length of the file bounds their number.
    if (packet.slot > offset / kPacketHeaderBytes) return std::nullopt;
    if (index_fault(packet, *payload, offset, {})) return std::nullopt;
    return static_cast<std::int64_t>(packet.slot);
}

std::optional<std::string> wrong_entry(const std::vector<IndexEntry>& entries,
                                       const FileWindow& file, const Framing& framing) {
    if (!file.file_bytes()) return std::nullopt;
    for (const IndexEntry& entry : entries) {
        const auto start = file.read_at(entry.offset, kPacketHeaderBytes);
        const bool packet = start && start_of(*start, framing) == Start::kPacket;
        const PacketHeader header = packet ? decode_packet_header(*start) : PacketHeader{};
        if (!packet || header.kind != PacketKind::kSamples || header.slot != entry.slot ||
            header.first_row != 0)
            return fmt::format("the index says that slot {} begins at byte {}, but it does not",
                               entry.slot, entry.offset);
    }
    return std::nullopt;
}

}  // namespace stipple
