// Packets that are good, each by itself, and yet not those of the stream that was recorded.
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/stream/stream_bytes.h"

namespace stipple {
namespace {

using Packets = std::vector<SamplePacket>;

const std::string kOtherPackets =
    "the packets are not those that were recorded, though each is good (checksum of all packets)";

/// Every pixel is due in every slot, so that all packets are alike but for their DN.
StreamHeader even_header(const std::string& provenance) {
    StreamHeader header = varied_header({4, 5, 1}, 10);
    header.schedule = {1, 1, 1, {0, 1}, {{0, 1}}};
    header.provenance = provenance;
    return header;
}

/// Two bands in each of eight slots.
Packets packets_of(const StreamHeader& header) {
    return random_packets(header, 8, 2);
}

/// The same of another recording: each bit of each DN differs.
Packets other_packets_of(const StreamHeader& header) {
    Packets packets = packets_of(header);
    for (SamplePacket& packet : packets)
        for (std::uint16_t& dn : packet.dn) dn = static_cast<std::uint16_t>(1023 - dn);
    return packets;
}

/// All that a tolerant reader reports of `bytes` is that checksum, and a strict one refuses them.
void expect_told_by_the_checksum_alone(const std::string& bytes) {
    const StreamReport report = read_bytes(bytes).report;
    EXPECT_EQ(causes(report), kOtherPackets + '\n');
    EXPECT_EQ(report.missing_slots, 0);
    EXPECT_TRUE(report.complete);
    expect_parts(message_of<InputError>([&] { return read_bytes(bytes, ReadPolicy::kStrict); }),
                 {": byte " + std::to_string(bytes.size() - kEndMarkerBytes), kOtherPackets});
}

TEST(WholeStreamTest, OfATornFileNothingOfTheSecondRecordingIsRead) {
    const StreamHeader header = even_header("footage = \"a.npy\"\n");
    const Packets packets = packets_of(header);
    const StreamBytes a = bytes_of(header, packets);
    const StreamHeader other = even_header("footage = \"b.npy\"\n");
    const StreamBytes b = bytes_of(other, other_packets_of(other));
    ASSERT_EQ(a.begins, b.begins);
    for (std::size_t tear = a.begins.front(); tear < a.bytes.size(); ++tear) {
        const auto [read, report] = read_bytes(a.bytes.substr(0, tear) + b.bytes.substr(tear));
        // Bytes that both have may be of either.
        std::size_t differs = tear;
        while (a.bytes[differs] == b.bytes[differs]) ++differs;
        const auto after = std::ranges::upper_bound(a.begins, differs);
        const auto whole = std::min(after - a.begins.begin() - 1, std::ssize(packets));
        EXPECT_EQ(read, Packets(packets.begin(), packets.begin() + whole)) << tear;
        ASSERT_EQ(report.damage.size(), 1U) << tear << '\n' << causes(report);
        EXPECT_EQ(report.damage[0].offset, *(after - 1));
        EXPECT_EQ(report.damage[0].bytes, a.bytes.size() - *(after - 1));
        EXPECT_FALSE(report.complete);
    }
}

TEST(WholeStreamTest, ATearBetweenRecordingsWithTheSameHeaderIsToldAtTheEnd) {
    const StreamHeader header = even_header("camera = \"1\"\n");
    const StreamBytes a = bytes_of(header, packets_of(header));
    const StreamBytes b = bytes_of(header, other_packets_of(header));
    for (std::size_t i = 1; i < 16; ++i)
        expect_told_by_the_checksum_alone(a.bytes.substr(0, a.begins[i]) +
                                          b.bytes.substr(b.begins[i]));
    // Where that end is missing, nobody knows.
    EXPECT_EQ(causes(read_bytes(a.bytes.substr(0, a.begins[4]) +
                                b.bytes.substr(b.begins[4], b.begins[8] - b.begins[4]))
                         .report),
              "");
}

TEST(WholeStreamTest, TheChecksumTellsExchangedAndRepeatedSamples) {
    const StreamHeader header = even_header("");
    const Packets packets = packets_of(header);
    const StreamBytes original = bytes_of(header, packets);
    const auto expect_told = [&](Packets changed) {
        for (std::size_t i = 0; i < changed.size(); ++i)
            changed[i].slot = static_cast<std::int64_t>(i / 2);
        const StreamBytes stream = bytes_of(header, changed);
        EXPECT_EQ(causes(read_bytes(stream.bytes, ReadPolicy::kStrict).report), "");
        expect_told_by_the_checksum_alone(with_checksum_of(original, stream));
    };
    for (std::ptrdiff_t slot = 0; slot < 7; ++slot) {
        Packets changed = packets;
        std::swap(changed[static_cast<std::size_t>(2 * slot)].dn, changed.back().dn);
        expect_told(changed);
        changed = packets;
        changed.erase(changed.begin() + 2 * slot, changed.begin() + 2 * slot + 2);
        expect_told(changed);
        const Packets twice(packets.begin() + 2 * slot, packets.begin() + 2 * slot + 2);
        changed = packets;
        changed.insert(changed.begin() + 2 * slot, twice.begin(), twice.end());
        expect_told(changed);
    }
}

// A CRC over bytes that end in their own CRC depends on their number alone; that over the CRCs of
// packets does not. Any one bit of any packet, with all CRCs of that packet made good, changes it.
TEST(WholeStreamTest, EveryBitOfEveryPacketCounts) {
    const StreamHeader header = even_header("");
    Packets packets = packets_of(header);
    const StreamBytes original = bytes_of(header, packets);
    for (SamplePacket& packet : packets)
        for (int bit = 0; bit < 10; ++bit) {
            packet.dn.back() = static_cast<std::uint16_t>(packet.dn.back() ^ (1U << bit));
            expect_told_by_the_checksum_alone(
                with_checksum_of(original, bytes_of(header, packets)));
            packet.dn.back() = static_cast<std::uint16_t>(packet.dn.back() ^ (1U << bit));
        }
}

TEST(WholeStreamTest, AWrongChecksumInAnEndMarkerOfVersion2IsReported) {
    const StreamHeader header = even_header("");
    const StreamBytes none = bytes_of(header, {});
    expect_told_by_the_checksum_alone(with_checksum_of(bytes_of(header, packets_of(header)), none));
}

}  // namespace
}  // namespace stipple
