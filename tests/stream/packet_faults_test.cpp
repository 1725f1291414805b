// Packets whose CRCs are good and whose fields break a rule: made by another program.
#include <gtest/gtest.h>

#include "core/error.h"
#include "stream/bit_packing.h"
#include "stream/slot_index.h"
#include "tests/stream/stream_bytes.h"

namespace stipple {
namespace {

/// Three slots; `broken` takes the place of the packet of slot 1.
struct BrokenStream {
    StreamHeader header = varied_header({4, 5, 1}, 10);
    std::vector<SamplePacket> packets = random_packets(header, 3, 4);
    StreamBytes stream = bytes_of(header, packets);

    /// The fields of the good packet of slot 1.
    [[nodiscard]] PacketHeader good() const {
        PacketHeader packet;
        packet.slot = 1;
        packet.rows = 4;
        packet.samples = static_cast<std::uint32_t>(packets[1].dn.size());
        return packet;
    }
    [[nodiscard]] std::string good_payload() const {
        return stream.bytes.substr(stream.begins[1] + kPacketHeaderBytes,
                                   stream.begins[2] - stream.begins[1] - kPacketHeaderBytes);
    }
    [[nodiscard]] std::string with(const std::string& broken) const {
        return stream.bytes.substr(0, stream.begins[1]) + broken +
               stream.bytes.substr(stream.begins[2]);
    }
};

/// A tolerant reader says `cause` and goes on with slot 2; a strict one says it and stops.
void expect_refused(const BrokenStream& s, const std::string& broken, const std::string& cause) {
    const auto [packets, report] = read_bytes(s.with(broken));
    EXPECT_EQ(packets, (std::vector{s.packets[0], s.packets[2]})) << cause;
    EXPECT_EQ(causes(report), cause + "\nslot 1 is missing\n");
    EXPECT_EQ(report.damage.front().offset, s.stream.begins[1]);
    EXPECT_EQ(report.damage.front().bytes, broken.size());
    EXPECT_EQ(report.unexpected_packets, cause.ends_with("not what is due") ? 1U : 0U);
    expect_parts(
        message_of<InputError>([&] { return read_bytes(s.with(broken), ReadPolicy::kStrict); }),
        {": byte " + std::to_string(s.stream.begins[1]) + ": " + cause});
}

template <typename Change>
void expect_refused(Change&& change, const std::string& cause) {
    const BrokenStream s;
    PacketHeader packet = s.good();
    std::string payload = s.good_payload();
    change(packet, payload);
    expect_refused(s, framed(packet, payload, s.stream.seed()), cause);
}

TEST(PacketFaultsTest, TheUnchangedPacketIsGood) {
    const BrokenStream s;
    EXPECT_EQ(s.with(framed(s.good(), s.good_payload(), s.stream.seed())), s.stream.bytes);
}

TEST(PacketFaultsTest, ReservedBytesAndUnknownFlagsAreRefused) {
    expect_refused([](auto& packet, auto&) { packet.switches = 0x100; },
                   "reserved bytes are not zero");
    expect_refused([](auto& packet, auto&) { packet.flags = 4; }, "unknown flags 0x4");
}

TEST(PacketFaultsTest, ASlotBeyondTheLimitIsRefused) {
    expect_refused([](auto& packet, auto&) { packet.slot = kMaxSlot + 1; },
                   "slot 9007199254740992 is not below 2^53");
}

TEST(PacketFaultsTest, RowsOutsideTheArrayAreRefused) {
    expect_refused([](auto& packet, auto&) { packet.rows = 0; },
                   "rows 0+0 are outside the 4 rows of the array");
    expect_refused([](auto& packet, auto&) { packet.rows = 5; },
                   "rows 0+5 are outside the 4 rows of the array");
    expect_refused([](auto& packet, auto&) { packet.first_row = 65535; },
                   "rows 65535+4 are outside the 4 rows of the array");
}

TEST(PacketFaultsTest, SamplesThatAreNotDueAreRefused) {
    expect_refused(
        [](PacketHeader& packet, std::string& payload) {
            ++packet.samples;
            payload.resize(packed_bytes(packet.samples, 10));
        },
        "3 samples are not what is due");
    expect_refused(
        [](PacketHeader& packet, std::string& payload) {
            packet.samples = 0;
            payload.clear();
        },
        "0 samples are not what is due");
    expect_refused([](auto& packet, auto&) { packet.flags = SamplePacket::kDropped; },
                   "2 samples are not what is due");
}

TEST(PacketFaultsTest, APayloadThatDoesNotFitItsSamplesIsRefused) {
    expect_refused([](auto&, std::string& payload) { payload += '\0'; },
                   "2 samples of 10 bits in 4 bytes");
}

TEST(PacketFaultsTest, UnusedBitsThatAreSetAreRefused) {
    expect_refused(
        [](auto&, std::string& payload) {
            payload.back() = static_cast<char>(payload.back() | 0x40);
        },
        "unused bits are not zero");
}

TEST(PacketFaultsTest, KindsThatAreNotSupportedAreSteppedOver) {
    expect_refused([](auto& packet, auto&) { packet.kind = PacketKind::kAddressed; },
                   "packets of kind 2 are not supported");
    // Even if they hold what looks like a packet.
    const BrokenStream s;
    PacketHeader packet;
    packet.kind = PacketKind{77};
    const std::uint32_t seed = s.stream.seed();
    expect_refused(s, framed(packet, framed(s.good(), s.good_payload(), seed), seed),
                   "packets of kind 77 are not supported");
}

TEST(PacketFaultsTest, APayloadBeyondItsLimitIsNotWaitedFor) {
    const BrokenStream s;
    std::string broken = framed(s.good(), "", s.stream.seed());
    const auto numbers = as_numbers(broken);
    store(&numbers[24], kMaxPayloadBytes + 1);
    store(&numbers[32], crc32c(numbers.first(32), s.stream.seed()));
    expect_refused(s, broken, "a payload is beyond 2^29 bytes");
}

/// An index of `entries`, with `slots` in its slot field, in place of the good one.
std::string with_index(const BrokenStream& s, std::uint64_t slots,
                       const std::vector<IndexEntry>& entries) {
    PacketHeader packet;
    packet.kind = PacketKind::kIndex;
    packet.slot = slots;
    packet.samples = static_cast<std::uint32_t>(entries.size());
    std::string payload(entries.size() * kIndexEntryBytes, '\0');
    store_index(entries, as_numbers(payload));
    const std::uint32_t seed = s.stream.seed();
    const std::size_t index = s.packets.size();  // the piece that it is
    std::string bytes = s.stream.bytes.substr(0, s.stream.begins[index]);
    std::uint32_t checksum = seed;
    bytes += framed(packet, payload, seed);
    for (std::size_t i = 0; i <= index; ++i)
        checksum = add_to_checksum(checksum, as_numbers(bytes).subspan(s.stream.begins[i]));
    const auto marker = encode_end_marker(s.stream.begins[index], checksum, seed);
    return bytes + std::string(marker.begin(), marker.end());
}

void expect_index_refused(const BrokenStream& s, const std::string& bytes,
                          const std::string& cause) {
    const auto [packets, report] = read_bytes(bytes);
    EXPECT_EQ(packets, s.packets);
    EXPECT_EQ(causes(report), cause + '\n');
    expect_parts(message_of<InputError>([&] { return read_bytes(bytes, ReadPolicy::kStrict); }),
                 {": byte " + std::to_string(s.stream.begins[s.packets.size()]) + ": " + cause});
}

std::string impossible_entry(int entry, std::uint64_t slot, std::uint64_t offset) {
    return "index entry " + std::to_string(entry) + " (slot " + std::to_string(slot) + ", offset " +
           std::to_string(offset) + ") is impossible";
}

TEST(PacketFaultsTest, AnIndexMayLeaveSlotsOut) {
    const BrokenStream s;
    const auto bytes = with_index(s, 3, {{1, s.stream.begins[1]}});
    EXPECT_EQ(read_bytes(bytes, ReadPolicy::kStrict).packets, s.packets);
}

TEST(PacketFaultsTest, AnIndexThatIsWrongIsReported) {
    const BrokenStream s;
    const auto& at = s.stream.begins;
    const std::string fewer = with_index(s, 2, {});
    expect_index_refused(s, fewer.substr(0, fewer.size() - kEndMarkerBytes),
                         "the index counts 2 slots, but slot 3 row 0 is due next");
    expect_index_refused(s, with_index(s, 3, {{3, at[2]}}), impossible_entry(0, 3, at[2]));
    expect_index_refused(s, with_index(s, 3, {{0, at[0]}, {0, at[1]}}),
                         impossible_entry(1, 0, at[1]));
    expect_index_refused(s, with_index(s, 3, {{0, at[1]}, {1, at[0]}}),
                         impossible_entry(1, 1, at[0]));
    expect_index_refused(s, with_index(s, 3, {{0, at[3]}}), impossible_entry(0, 0, at[3]));
    expect_index_refused(
        s, with_index(s, 3, {{0, at[1]}}),
        "the index says that slot 0 begins at byte " + std::to_string(at[1]) + ", but it does not");
}

TEST(PacketFaultsTest, SlotsThatTheIndexDoesNotCountAreDamage) {
    const BrokenStream s;
    const MemoryFile file(with_index(s, 2, {}));
    StreamReader reader(file.path());
    EXPECT_EQ(reader.slots(), 2);
    EXPECT_EQ(read_packets(reader), (std::vector{s.packets[0], s.packets[1]}));
    EXPECT_EQ(reader.report().slots, 2);
    EXPECT_EQ(causes(reader.report()), "slot 2 is not one of the 2 in the index\n");
}

TEST(PacketFaultsTest, AnIndexLeadsToTheFirstRowsOfASlot) {
    BrokenStream s;
    s.packets = random_packets(s.header, 3, 2);  // two bands in each slot
    s.stream = bytes_of(s.header, s.packets);
    const auto& at = s.stream.begins;
    EXPECT_EQ(read_bytes(with_index(s, 3, {{1, at[2]}}), ReadPolicy::kStrict).packets, s.packets);
    expect_index_refused(
        s, with_index(s, 3, {{1, at[3]}}),
        "the index says that slot 1 begins at byte " + std::to_string(at[3]) + ", but it does not");
}

TEST(PacketFaultsTest, AnIndexThatCountsMoreSlotsSaysThatTheyAreMissing) {
    const BrokenStream s;
    const auto [packets, report] = read_bytes(with_index(s, 5, {}));
    EXPECT_EQ(causes(report), "slots 3..4 are missing\n");
    EXPECT_EQ(report.slots, 5);
    EXPECT_EQ(report.missing_slots, 2);
}

TEST(PacketFaultsTest, NothingMayComeAfterTheIndex) {
    const BrokenStream s;
    const auto& at = s.stream.begins;
    std::string bytes = s.stream.bytes;
    bytes.insert(at[4], s.stream.bytes.substr(at[2], at[3] - at[2]));
    EXPECT_EQ(causes(read_bytes(bytes).report), "a packet after the index\n");
}

TEST(PacketFaultsTest, AnEndMarkerPointsToTheIndex) {
    const BrokenStream s;
    const auto marker = encode_end_marker(17, 0, s.stream.seed());
    const std::string text(marker.begin(), marker.end());
    const std::string cause = "the end marker does not point to an index before it\n";
    const std::size_t end = s.stream.begins[4];
    EXPECT_EQ(causes(read_bytes(s.stream.bytes.substr(0, end) + text).report), cause);
    const std::size_t index = s.stream.begins[3];
    EXPECT_EQ(causes(read_bytes(s.stream.bytes.substr(0, index) + text).report), cause);
}

}  // namespace
}  // namespace stipple
