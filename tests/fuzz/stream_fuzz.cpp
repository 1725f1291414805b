#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "core/error.h"
#include "stream/crc32c.h"
#include "stream/header_codec.h"
#include "stream/little_endian.h"
#include "stream/packet_codec.h"
#include "stream/stream_reader.h"
#include "tests/stream/memory_file.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kFixedHeaderBytes = 96;

void require(bool property) {
    if (!property) std::abort();
}

/// True if the header asks for the random schedule of a large array: 120 bytes may ask for seconds.
bool asks_for_much(const Bytes& bytes) {
    const std::size_t sites =
        std::size_t{load<std::uint16_t>(&bytes[16])} * load<std::uint16_t>(&bytes[18]);
    return bytes[84] == 1 && sites > 4096;
}

/// Makes the CRCs of the header good, those of an explicit schedule too, and returns its length.
std::size_t repair_header(Bytes& bytes) {
    const std::uint64_t length = load<std::uint32_t>(&bytes[12]);
    if (length < kFixedHeaderBytes || length > bytes.size()) return bytes.size();
    const std::uint64_t schedule =
        std::uint64_t{92} + load<std::uint32_t>(&bytes[72]) + load<std::uint32_t>(&bytes[76]);
    const std::uint64_t schedule_bytes = load<std::uint32_t>(&bytes[80]);
    const std::span<const std::uint8_t> view(bytes);
    if (bytes[84] == 0 && schedule + schedule_bytes <= length)
        store(&bytes[88], crc32c(view.subspan(schedule, schedule_bytes)));
    store(&bytes[length - 4], crc32c(view.first(length - 4)));
    return length;
}

/// The same for each packet and end marker, so that the fuzzer gets beyond the CRCs.
Bytes repaired(Bytes bytes) {
    const std::span<std::uint8_t> view(bytes);
    std::size_t at = repair_header(bytes);
    const Framing framing = framing_of(view.first(at));
    const std::size_t marker = end_marker_bytes(framing);
    std::uint32_t checksum = framing.seed;
    while (at + marker <= bytes.size()) {
        const auto rest = view.subspan(at);
        const auto sync = load<std::uint32_t>(rest.data());
        if (sync == 0x444E45C5) {
            if (framing.version != 1) store(&rest[12], checksum);
            store(&rest[marker - 4], crc32c(rest.first(marker - 4), framing.seed));
        }
        if (sync == 0x4B5053C5 && rest.size() >= kPacketHeaderBytes) {
            const std::size_t left = rest.size() - kPacketHeaderBytes;
            const std::size_t payload = load<std::uint32_t>(&rest[24]);
            if (payload <= left)
                store(&rest[28], crc32c(rest.subspan(kPacketHeaderBytes, payload)));
            store(&rest[32], crc32c(rest.first(32), framing.seed));
            checksum = add_to_checksum(checksum, rest);
            at += kPacketHeaderBytes + (payload <= left ? payload : 0);
        } else {
            ++at;
        }
    }
    return bytes;
}

/// A packet that is delivered is one that a writer could have written.
void check_packet(const StreamHeader& header, const SamplePacket& packet) {
    require(packet.slot >= 0 && packet.first_row >= 0 && packet.rows > 0);
    require(packet.first_row + packet.rows <= header.shape.rows);
    for (const unsigned dn : packet.dn)
        require(dn >> static_cast<unsigned>(header.calibration.bit_depth) == 0);
    if ((packet.flags & SamplePacket::kDropped) != 0)
        require(packet.dn.empty());
    else if (header.shape.pixels() < 100000)
        require(packet.dn.size() == static_cast<std::size_t>(header.shape.planes) *
                                        count_due(header.schedule, packet.slot, packet.first_row,
                                                  packet.rows, header.shape.cols));
}

struct Reading {
    bool refused = false;
    std::vector<SamplePacket> packets;
    StreamReport report;
};

Reading read(const Bytes& bytes, ReadPolicy policy) {
    const MemoryFile file({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    Reading reading;
    try {
        StreamReader reader(file.path(), policy);
        // There is one way only to write a header, but for the version.
        Bytes header = encode_header(reader.header(), "");
        header[8] = bytes[8];
        repair_header(header);
        require(std::equal(header.begin(), header.end(), bytes.begin()));
        for (SamplePacket packet; reader.next(packet);) {
            if (policy != ReadPolicy::kAnySchedule) check_packet(reader.header(), packet);
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

/// What a strict reader accepts is whole for a tolerant one, and the other way round; one that
/// takes any schedule gets through, too.
void check_both_policies(const Bytes& bytes) {
    const Reading tolerant = read(bytes, ReadPolicy::kTolerant);
    const Reading strict = read(bytes, ReadPolicy::kStrict);
    const bool whole =
        !tolerant.refused && tolerant.report.damage.empty() && tolerant.report.tail_bytes == 0;
    require(strict.refused == !whole);
    if (whole) require(strict.packets == tolerant.packets);
    static_cast<void>(read(bytes, ReadPolicy::kAnySchedule));
}

}  // namespace
}  // namespace stipple

/// Input: a stream; it is read as it is, and with all CRCs made good.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const Bytes bytes(data, data + size);
    if (size >= kFixedHeaderBytes && asks_for_much(bytes)) return 0;
    check_both_policies(bytes);
    if (size >= kFixedHeaderBytes) check_both_policies(repaired(bytes));
    return 0;
}
