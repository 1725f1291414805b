#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/error.h"
#include "stream/crc32c.h"
#include "stream/header_codec.h"
#include "stream/little_endian.h"
#include "stream/schedule_switch.h"
#include "stream/stream_reader.h"
#include "tests/fuzz/require.h"
#include "tests/fuzz/stream_pieces.h"
#include "tests/support/memory_file.h"

namespace stipple {
namespace {

/// A packet that is delivered is one that a writer could have written.
void check_packet(const StreamHeader& header, const SamplePacket& packet) {
    require(packet.slot >= 0 && packet.first_row >= 0 && packet.rows > 0);
    require(packet.first_row + packet.rows <= header.shape.rows);
    for (const unsigned dn : packet.dn)
        require(dn >> static_cast<unsigned>(header.calibration.bit_depth) == 0);
    if ((packet.flags & SamplePacket::kDropped) != 0)
        require(packet.dn.empty());
    else if (const SchedulePart part = schedule_at(header, packet.slot);
             header.shape.pixels() < 100000)
        require(packet.dn.size() == static_cast<std::size_t>(header.shape.planes) *
                                        count_due(*part.schedule, readout_slot(part, packet.slot),
                                                  packet.first_row, packet.rows,
                                                  header.shape.cols));
}

/// An exposure that is read has 64 slots at most, the last one open, or it is unknown.
void check_exposures(const StreamHeader& header, const SamplePacket& packet) {
    const auto parts = schedule_parts(header);
    const SchedulePart part = schedule_at(header, packet.slot);
    if (part.first_slot == 0 || header.shape.pixels() > 100) return;
    for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row)
        for_each_readout(
            *part.schedule, readout_slot(part, packet.slot), row, header.shape.cols,
            [&](int col, int) {
                const auto read = read_exposure(parts, {packet.slot, row, col});
                if (!read) return;
                require(read->first_slot >= 0 && (read->open_slots & 1U) != 0);
                require(read->open_slots >> static_cast<unsigned>(packet.slot - read->first_slot) ==
                        1);
            });
}

/// There is one way only to write a header, but for the version.
void check_header(const StreamHeader& header, std::span<const std::uint8_t> bytes) {
    constexpr std::size_t kVersionAt = 8;
    Bytes again = encode_header(header, "");
    again[kVersionAt] = bytes[kVersionAt];
    const std::size_t crc_at = again.size() - 4;
    store(&again[crc_at], crc32c(std::span(again).first(crc_at)));
    require(std::ranges::equal(again, bytes.first(again.size())));
}

struct Reading {
    bool refused = false;
    std::vector<SamplePacket> packets;
    StreamReport report;
};

Reading read(std::span<const std::uint8_t> bytes, ReadPolicy policy) {
    const MemoryFile file(bytes);
    Reading reading;
    try {
        StreamReader reader(file.path(), policy);
        check_header(reader.header(), bytes);
        reader.follow_switches();
        for (SamplePacket packet; reader.next(packet);) {
            if (policy != ReadPolicy::kAnySchedule) check_packet(reader.header(), packet);
            check_exposures(reader.header(), packet);
            require(packet.dn.size() <= reader.header().shape.sites());
            reading.packets.push_back(packet);
        }
        reading.report = reader.report();
        require(reading.report.packets == reading.packets.size());
        require(reading.report.missing_slots <= reading.report.slots);
    } catch (const InputError&) {
        reading.refused = true;
    }
    return reading;
}

/// From the middle on, a whole stream gives the packets that follow there.
void check_seek(std::span<const std::uint8_t> bytes, const Reading& whole) {
    const MemoryFile file(bytes);
    StreamReader reader(file.path());
    reader.follow_switches();
    const std::int64_t begin = reader.seek(whole.report.slots / 2);
    std::vector<SamplePacket> expected = whole.packets, packets;
    std::erase_if(expected, [&](const SamplePacket& packet) { return packet.slot < begin; });
    for (SamplePacket packet; reader.next(packet);) packets.push_back(packet);
    require(packets == expected && reader.report().damage.empty());
}

/// What a strict reader accepts is whole for a tolerant one, and the other way round; one that
/// takes any schedule gets through, too.
void check_both_policies(std::span<const std::uint8_t> bytes) {
    const Reading tolerant = read(bytes, ReadPolicy::kTolerant);
    const Reading strict = read(bytes, ReadPolicy::kStrict);
    const bool whole =
        !tolerant.refused && tolerant.report.damage.empty() && tolerant.report.tail_bytes == 0;
    require(strict.refused == !whole);
    if (whole) require(strict.packets == tolerant.packets);
    if (whole) check_seek(bytes, tolerant);
    static_cast<void>(read(bytes, ReadPolicy::kAnySchedule));
}

}  // namespace
}  // namespace stipple

/// Input: a stream.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const std::span<const std::uint8_t> bytes(data, size);
    if (size >= kStreamHeadBytes && asks_for_much(bytes)) return 0;
    check_both_policies(bytes);
    return 0;
}
