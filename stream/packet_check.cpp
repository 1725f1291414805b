#include "stream/packet_order.h"

#include <fmt/format.h>

#include <utility>

#include "stream/bit_packing.h"
#include "stream/due_count.h"
#include "stream/sample_packet.h"
#include "stream/schedule_switch.h"
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
        return matches_counts(*rule.counts, readout_slot(schedule_at(stream, slot), slot), band,
                              planes, packet.samples);
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

std::optional<std::string> entry_fault(const std::vector<IndexEntry>& entries, std::uint64_t slots,
                                       std::uint64_t index_offset) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const bool rises = i == 0 || (entries[i].slot > entries[i - 1].slot &&
                                      entries[i].offset > entries[i - 1].offset);
        if (!rises || entries[i].slot >= slots || entries[i].offset >= index_offset)
            return fmt::format("index entry {} (slot {}, offset {}) is impossible", i,
                               entries[i].slot, entries[i].offset);
    }
    return std::nullopt;
}

/// A packet of version 4 has the number of the switch whose schedule it follows.
std::optional<std::string> switch_fault(const StreamHeader& stream, const PacketHeader& packet) {
    const int known = last_switch(stream);
    if (packet.switches != known)
        return stream.may_switch
                   ? fmt::format(
                         "it follows switch {} of the schedule, but switch {} was read last",
                         packet.switches, known)
                   : "reserved bytes are not zero";
    if (known > 0 && packet.slot < static_cast<std::uint64_t>(stream.switches.back().slot))
        return fmt::format("slot {} is before switch {}", packet.slot, known);
    return std::nullopt;
}

}  // namespace

Fault sample_fault(const StreamHeader& stream, const PacketHeader& packet, Bytes payload,
                   StreamPosition expected, const DueRule& rule) {
    constexpr unsigned kKnownFlags = SamplePacket::kOverrun | SamplePacket::kDropped;
    if (auto fault = switch_fault(stream, packet)) return PacketFault{std::move(*fault)};
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

std::optional<std::string> switch_fault(const StreamHeader& stream, const PacketHeader& packet,
                                        StreamPosition expected) {
    if (!stream.may_switch) return "packets of kind 4 are not supported";
    if (packet.flags != 0 || packet.first_row != 0 || packet.rows != 0 || packet.samples != 0)
        return "flags, rows or samples of a switch are not zero";
    if (packet.slot > kMaxSlot) return fmt::format("slot {} is not below 2^53", packet.slot);
    const std::int64_t before = stream.switches.empty() ? 0 : stream.switches.back().slot;
    const auto slot = static_cast<std::int64_t>(packet.slot);
    if (packet.switches <= last_switch(stream) || slot <= before ||
        StreamPosition{slot, 0} < expected)
        return fmt::format("switch {} at slot {} comes twice or too late", packet.switches, slot);
    if (stream.shape.pixels() * packet.switches > kMaxPixelSwitches)
        return fmt::format("{} switches of {} x {} pixels are more than 2^32", packet.switches,
                           stream.shape.rows, stream.shape.cols);
    return std::nullopt;
}

std::optional<std::string> index_fault(const PacketHeader& packet, Bytes payload,
                                       std::uint64_t offset, StreamPosition expected,
                                       int switches) {
    const bool reserved = switches == kNoSwitches && packet.switches != 0;
    if (reserved || packet.flags != 0 || packet.first_row != 0 || packet.rows != 0)
        return "flags, rows or reserved bytes of the index are not zero";
    if (packet.switches < switches)
        return fmt::format("the index counts {} switches of the schedule", packet.switches);
    if (packet.slot > kMaxSlot) return fmt::format("{} slots are not below 2^53", packet.slot);
    if (StreamPosition{static_cast<std::int64_t>(packet.slot), 0} < expected)
        return fmt::format("the index counts {} slots, but slot {} row {} is due next", packet.slot,
                           expected.slot, expected.row);
    const std::uint64_t entries = std::uint64_t{packet.samples} + packet.switches;
    if (payload.size() != entries * kIndexEntryBytes)
        return fmt::format("{} index entries in {} bytes", entries, payload.size());
    const IndexEntries index = load_index(payload, packet.switches);
    if (auto fault = entry_fault(index.slots, packet.slot, offset)) return fault;
    return entry_fault(index.switches, packet.slot + 1, offset);
}

}  // namespace stipple
