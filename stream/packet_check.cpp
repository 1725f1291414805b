#include "stream/packet_order.h"

#include <fmt/format.h>

#include "stream/bit_packing.h"
#include "stream/due_count.h"
#include "stream/sample_packet.h"
#include "stream/slot_index.h"

namespace stipple {
namespace {

using Bytes = std::span<const std::uint8_t>;
using Fault = std::optional<PacketFault>;

bool unused_bits_are_zero(std::size_t samples, int bit_depth, Bytes payload) {
    const auto used_bits = samples * static_cast<std::size_t>(bit_depth) % 8;
    return used_bits == 0 || payload.back() >> used_bits == 0;
}

bool is_due(const StreamHeader& stream, const PacketHeader& packet, const DueRule& rule) {
    const RowBand band{packet.first_row, packet.rows};
    const auto slot = static_cast<std::int64_t>(packet.slot);
    const auto planes = static_cast<std::size_t>(stream.shape.planes);
    if (rule.counts != nullptr)
        return matches_counts(*rule.counts, slot, band, planes, packet.samples);
    if (!rule.any) return matches_schedule(stream, slot, band, packet.samples);
    const FrameShape of_band{packet.rows, stream.shape.cols, stream.shape.planes};
    return packet.samples <= of_band.sites();
}

Fault payload_fault(const StreamHeader& stream, const PacketHeader& packet, Bytes payload,
                    const DueRule& rule) {
    const int bit_depth = stream.calibration.bit_depth;
    if (payload.size() != packed_bytes(packet.samples, bit_depth))
        return PacketFault{fmt::format("{} samples of {} bits in {} bytes", packet.samples,
                                       bit_depth, payload.size())};
    const bool dropped = (packet.flags & SamplePacket::kDropped) != 0;
    const bool expected = dropped ? packet.samples == 0 : is_due(stream, packet, rule);
    if (!expected)
        return PacketFault{fmt::format("{} samples are not what is due", packet.samples), true};
    if (!unused_bits_are_zero(packet.samples, bit_depth, payload))
        return PacketFault{"unused bits are not zero"};
    return std::nullopt;
}

std::optional<std::string> entry_fault(Bytes payload, std::uint64_t slots,
                                       std::uint64_t index_offset) {
    const auto entries = load_index(payload);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const bool rises = i == 0 || (entries[i].slot > entries[i - 1].slot &&
                                      entries[i].offset > entries[i - 1].offset);
        if (!rises || entries[i].slot >= slots || entries[i].offset >= index_offset)
            return fmt::format("index entry {} (slot {}, offset {}) is impossible", i,
                               entries[i].slot, entries[i].offset);
    }
    return std::nullopt;
}

}  // namespace

Fault sample_fault(const StreamHeader& stream, const PacketHeader& packet, Bytes payload,
                   StreamPosition expected, const DueRule& rule) {
    constexpr unsigned kKnownFlags = SamplePacket::kOverrun | SamplePacket::kDropped;
    if (packet.reserved != 0) return PacketFault{"reserved bytes are not zero"};
    if ((packet.flags & ~kKnownFlags) != 0)
        return PacketFault{fmt::format("unknown flags {:#x}", packet.flags)};
    if (packet.slot > kMaxSlot)
        return PacketFault{fmt::format("slot {} is not below 2^53", packet.slot)};
    if (packet.rows < 1 || packet.first_row + packet.rows > stream.shape.rows)
        return PacketFault{fmt::format("rows {}+{} are outside the {} rows of the array",
                                       packet.first_row, packet.rows, stream.shape.rows)};
    if (StreamPosition{static_cast<std::int64_t>(packet.slot), packet.first_row} < expected)
        return PacketFault{
            fmt::format("slot {} row {} comes twice or too late", packet.slot, packet.first_row)};
    return payload_fault(stream, packet, payload, rule);
}

std::optional<std::string> index_fault(const PacketHeader& packet, Bytes payload,
                                       std::uint64_t offset, StreamPosition expected) {
    if (packet.reserved != 0 || packet.flags != 0 || packet.first_row != 0 || packet.rows != 0)
        return "flags, rows or reserved bytes of the index are not zero";
    if (packet.slot > kMaxSlot) return fmt::format("{} slots are not below 2^53", packet.slot);
    if (StreamPosition{static_cast<std::int64_t>(packet.slot), 0} < expected)
        return fmt::format("the index counts {} slots, but slot {} row {} is due next", packet.slot,
                           expected.slot, expected.row);
    if (payload.size() != std::uint64_t{packet.samples} * kIndexEntryBytes)
        return fmt::format("{} index entries in {} bytes", packet.samples, payload.size());
    return entry_fault(payload, packet.slot, offset);
}

}  // namespace stipple
