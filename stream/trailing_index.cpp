#include "stream/slot_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "stream/crc32c.h"
#include "stream/packet_codec.h"
#include "stream/packet_order.h"

namespace stipple {

namespace {

bool leads_to(PacketKind kind, const IndexEntry& entry, const BufferedReader& file,
              const Framing& framing) {
    const auto start = file.read_at(entry.offset, kPacketHeaderBytes);
    if (!start || start_of(*start, framing) != Start::kPacket) return false;
    const PacketHeader header = decode_packet_header(*start);
    return header.kind == kind && header.slot == entry.slot && header.first_row == 0;
}

}  // namespace

std::optional<TrailingIndex> read_trailing_index(const BufferedReader& file,
                                                 const Framing& framing) {
    const std::size_t marker_bytes = end_marker_bytes(framing);
    const std::uint64_t end = file.file_bytes().value_or(0);
    if (end < marker_bytes) return std::nullopt;
    const auto marker = file.read_at(end - marker_bytes, marker_bytes);
    if (!marker || start_of(*marker, framing) != Start::kEnd) return std::nullopt;
    const auto [offset, checksum] = decode_end_marker(*marker, framing);
    const auto start = file.read_at(offset, kPacketHeaderBytes);
    if (!start || start_of(*start, framing) != Start::kPacket) return std::nullopt;
    const PacketHeader packet = decode_packet_header(*start);
    const bool last = offset + kPacketHeaderBytes + packet.payload_bytes + marker_bytes == end;
    if (packet.kind != PacketKind::kIndex || !last) return std::nullopt;
    const auto payload = file.read_at(offset + kPacketHeaderBytes, packet.payload_bytes);
    if (!payload || crc32c(*payload) != packet.payload_crc) return std::nullopt;
    // Each slot takes a packet or more, so the length of the file bounds their number.
    if (packet.slot > offset / kPacketHeaderBytes) return std::nullopt;
    const int switches = framing.version < 4 ? kNoSwitches : 0;
    if (index_fault(packet, *payload, offset, {}, switches)) return std::nullopt;
    return TrailingIndex{static_cast<std::int64_t>(packet.slot), checksum,
                         load_index(*payload, packet.switches)};
}

std::optional<std::int64_t> slots_by_index(const BufferedReader& file, const Framing& framing) {
    const auto index = read_trailing_index(file, framing);
    return index ? std::optional(index->slots) : std::nullopt;
}

std::optional<IndexPlace> entry_before(const BufferedReader& file, const Framing& framing,
                                       std::int64_t slot) {
    auto index = read_trailing_index(file, framing);
    if (!index) return std::nullopt;
    const auto entry = last_before(index->entries.slots, slot);
    if (!entry || !leads_to(PacketKind::kSamples, *entry, file, framing)) return std::nullopt;
    return IndexPlace{*entry, std::move(index->entries.switches)};
}

std::optional<std::string> wrong_entry(const IndexEntries& entries, const BufferedReader& file,
                                       const Framing& framing) {
    if (!file.file_bytes()) return std::nullopt;
    for (const IndexEntry& entry : entries.slots)
        if (!leads_to(PacketKind::kSamples, entry, file, framing))
            return fmt::format("the index says that slot {} begins at byte {}, but it does not",
                               entry.slot, entry.offset);
    for (const IndexEntry& entry : entries.switches)
        if (!leads_to(PacketKind::kSwitch, entry, file, framing))
            return fmt::format(
                "the index says that slot {} has a switch at byte {}, but it has not", entry.slot,
                entry.offset);
    return std::nullopt;
}

}  // namespace stipple
