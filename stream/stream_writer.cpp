#include "stream/stream_writer.h"

#include <fmt/format.h>

#include <cassert>
#include <span>
#include <utility>
#include <vector>

#include "core/error.h"
#include "stream/append_file.h"
#include "stream/due_count.h"
#include "stream/header_codec.h"
#include "stream/packet_codec.h"
#include "stream/packet_order.h"
#include "stream/sample_codec.h"
#include "stream/schedule_switch.h"
#include "stream/slot_index.h"

namespace stipple {

struct StreamWriter::Impl {
    /// `encoded` comes in, so that the header is checked before the file is created.
    Impl(const std::filesystem::path& path, const StreamHeader& stream, const std::string& name,
         const std::vector<std::uint8_t>& encoded)
        : where(name),
          header(stream),
          file(path, name),
          order(stream.shape.rows),
          seed(framing_of(encoded).seed),
          checksum(seed) {
        header.switches.clear();  // those that a reader has met in another stream
        file.append(encoded);
    }

    [[nodiscard]] bool is_due(const SamplePacket& packet) const;
    void append(std::span<const std::uint8_t> packet) {
        file.append(packet);
        checksum = add_to_checksum(checksum, packet);
    }
    [[nodiscard]] std::uint16_t switches() const {
        return static_cast<std::uint16_t>(last_switch(header));
    }

    std::string where;
    StreamHeader header;
    AppendFile file;
    PacketOrder order;
    SlotIndex index;
    std::vector<IndexEntry> switch_places;
    JoinedExposures joined;
    std::vector<std::uint8_t> copy;  ///< of a switch packet, until its slot has been written
    std::uint32_t seed;              ///< of the CRCs of packets
    std::uint32_t checksum;          ///< of all packets written
};

bool StreamWriter::Impl::is_due(const SamplePacket& packet) const {
    if (StreamPosition{packet.slot, packet.first_row} != order.expected()) return false;
    if (packet.rows < 1 || packet.rows > header.shape.rows - packet.first_row) return false;
    if ((packet.flags & SamplePacket::kDropped) != 0) return packet.dn.empty();
    unsigned bits = 0;
    for (const unsigned dn : packet.dn) bits |= dn;
    if (bits >> static_cast<unsigned>(header.calibration.bit_depth) != 0) return false;
    return matches_schedule(header, packet.slot, {packet.first_row, packet.rows}, packet.dn.size());
}

StreamWriter::StreamWriter(const std::filesystem::path& file, const StreamHeader& header,
                           std::string where, std::int64_t first_slot) {
    if (where.empty()) where = file.string();
    impl_ = std::make_unique<Impl>(file, header, where, encode_header(header, where));
    impl_->order.begin_at(first_slot);
}

StreamWriter::~StreamWriter() = default;

void StreamWriter::write(const SamplePacket& packet) {
    assert(impl_->is_due(packet));
    const auto bytes =
        encode_samples(packet, impl_->header.calibration.bit_depth, impl_->seed, impl_->switches());
    if (packet.first_row == 0)
        impl_->index.add({static_cast<std::uint64_t>(packet.slot), impl_->file.bytes()});
    impl_->append(bytes);
    impl_->order.advance(packet.rows);
    if (impl_->order.expected().row == 0 && !impl_->copy.empty())
        impl_->append(std::exchange(impl_->copy, {}));
}

const ScheduleSwitch& StreamWriter::switch_schedule(ScheduleSwitch next) {
    Impl& stream = *impl_;
    const auto [slot, row] = stream.order.expected();
    assert(stream.header.may_switch && slot > 0 && row == 0);
    const auto fail = [&](const std::string& problem) { throw InputError(stream.where, problem); };
    const std::size_t number = std::size_t{stream.switches()} + 1;
    if (number > kMaxSwitches || stream.header.shape.pixels() * number > kMaxPixelSwitches)
        fail(fmt::format("{} switches of the schedule are more than a stream has", number));
    next.slot = slot;
    next.number = static_cast<std::uint16_t>(number);
    if (!stream.header.switches.empty() && stream.header.switches.back().slot == slot)
        fail(fmt::format("slot {} has a switch of the schedule already", slot));
    if (const auto fault = stream.joined.fault(stream.header, next)) fail(*fault);
    const auto payload = encode_switch(next, stream.header.shape, stream.where);
    PacketHeader header;
    header.kind = PacketKind::kSwitch;
    header.slot = static_cast<std::uint64_t>(slot);
    header.switches = next.number;
    stream.copy.assign(kPacketHeaderBytes, 0);
    stream.copy.insert(stream.copy.end(), payload.begin(), payload.end());
    frame_packet(header, stream.copy, stream.seed);
    stream.switch_places.push_back({header.slot, stream.file.bytes()});
    stream.append(stream.copy);
    return stream.header.switches.emplace_back(std::move(next));
}

void StreamWriter::finish() {
    const StreamPosition end = impl_->order.expected();
    if (end.row > 0)  // the rows of the last slot that never came
        write({end.slot, end.row, impl_->header.shape.rows - end.row, SamplePacket::kDropped, {}});
    std::vector<IndexEntry> entries(impl_->index.entries().begin(), impl_->index.entries().end());
    PacketHeader header;
    header.kind = PacketKind::kIndex;
    header.slot = static_cast<std::uint64_t>(impl_->order.expected().slot);
    header.samples = static_cast<std::uint32_t>(entries.size());
    header.switches = impl_->switches();
    entries.insert(entries.end(), impl_->switch_places.begin(), impl_->switch_places.end());
    std::vector<std::uint8_t> bytes(kPacketHeaderBytes + entries.size() * kIndexEntryBytes);
    store_index(entries, std::span(bytes).subspan(kPacketHeaderBytes));
    frame_packet(header, bytes, impl_->seed);
    const auto marker = encode_end_marker(impl_->file.bytes(),
                                          add_to_checksum(impl_->checksum, bytes), impl_->seed);
    bytes.insert(bytes.end(), marker.begin(), marker.end());
    impl_->file.append(bytes);
    impl_->file.close();
}

std::uint64_t StreamWriter::bytes_written() const {
    return impl_->file.bytes();
}

}  // namespace stipple
