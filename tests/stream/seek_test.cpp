// Reading from the middle of a stream.
#include <gtest/gtest.h>

#include <vector>

#include "tests/stream/stream_bytes.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Packets = std::vector<SamplePacket>;

/// The packets of `all` from `slot` on.
Packets from(const Packets& all, std::int64_t slot) {
    Packets rest;
    for (const SamplePacket& packet : all)
        if (packet.slot >= slot) rest.push_back(packet);
    return rest;
}

class SeekTest : public testing::Test {
  protected:
    /// The packets after a seek, without damage.
    Packets read_from(std::int64_t slot, std::int64_t reached) {
        StreamReader reader(file_, ReadPolicy::kStrict);
        EXPECT_EQ(reader.seek(slot), reached);
        Packets packets = read_packets(reader);
        EXPECT_TRUE(reader.report().complete);
        EXPECT_EQ(reader.report().missing_slots, 0);
        return packets;
    }
    void write(const std::string& bytes) { write_text(file_, bytes); }

    const TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_ / "a.stipple";
    const StreamHeader header_ = varied_header({7, 4, 1}, 10);
    const Packets packets_ = random_packets(header_, 20, 3);  // three bands in each slot
    const std::string bytes_ = bytes_of(header_, packets_).bytes;
};

TEST_F(SeekTest, ThePacketsAreThoseThatFollowInTheWholeStream) {
    write(bytes_);
    for (std::int64_t slot = 0; slot < 20; ++slot)
        EXPECT_EQ(read_from(slot, slot), from(packets_, slot)) << slot;
    EXPECT_EQ(read_from(1000, 19), from(packets_, 19));
}

TEST_F(SeekTest, WithoutAnEndItStaysAtTheBeginning) {
    write(bytes_.substr(0, bytes_.size() - 1));
    StreamReader reader(file_);
    EXPECT_EQ(reader.seek(10), 0);
    EXPECT_EQ(read_packets(reader), packets_);
}

TEST_F(SeekTest, ItMayBeRepeatedBackAndForth) {
    write(bytes_);
    StreamReader reader(file_, ReadPolicy::kStrict);
    for (const std::int64_t slot : {15, 3, 0, 19, 7}) {
        EXPECT_EQ(reader.seek(slot), slot);
        EXPECT_EQ(read_packets(reader), from(packets_, slot)) << slot;
        EXPECT_TRUE(reader.report().complete);
    }
}

TEST_F(SeekTest, WithoutAnEndItFindsTheSlotsThatWereRead) {
    write(bytes_.substr(0, bytes_.size() - 1));
    StreamReader reader(file_);
    SamplePacket packet;
    while (packet.slot < 12) ASSERT_TRUE(reader.next(packet));
    EXPECT_EQ(reader.seek(5), 5);
    EXPECT_EQ(read_packets(reader), from(packets_, 5));
    EXPECT_EQ(reader.seek(17), 17);
    EXPECT_EQ(read_packets(reader), from(packets_, 17));
}

TEST_F(SeekTest, DamageBeforeIsNotMetAndDamageAfterIsReported) {
    const StreamBytes stream = bytes_of(header_, packets_);
    std::string damaged = stream.bytes;
    damaged[stream.begins[5 * 3] + kPacketHeaderBytes] ^= 1;  // of slot 5
    write(damaged);
    EXPECT_EQ(read_from(6, 6), from(packets_, 6));
    StreamReader reader(file_);
    EXPECT_EQ(reader.seek(4), 4);
    EXPECT_EQ(read_packets(reader).size(), from(packets_, 4).size() - 1);
    EXPECT_EQ(reader.report().damage.size(), 2U);  // the packet, and the gap
    EXPECT_EQ(reader.report().missing_slots, 1);
}

TEST_F(SeekTest, AnEntryThatLeadsElsewhereIsNotFollowed) {
    const StreamBytes stream = bytes_of(header_, packets_);
    std::string damaged = stream.bytes;
    damaged[stream.begins[5 * 3] + 8] ^= 1;  // the slot in the header of slot 5
    write(damaged);
    StreamReader reader(file_);
    EXPECT_EQ(reader.seek(5), 0);
    EXPECT_EQ(read_packets(reader).size(), packets_.size() - 1);
}

// Packets with good CRCs, which are not what the index says.
TEST_F(SeekTest, AnEntryThatLeadsToAnotherPacketThanTheFirstOfItsSlotIsNotFollowed) {
    const StreamBytes stream = bytes_of(header_, packets_);
    const std::size_t begin = stream.begins[5 * 3], bytes = stream.begins[5 * 3 + 1] - begin;
    const auto reached = [&](const auto& change) {
        std::string changed = stream.bytes;
        const auto packet = as_numbers(changed).subspan(begin, bytes);
        PacketHeader header = decode_packet_header(packet);
        change(header);
        frame_packet(header, packet, stream.seed());
        write(changed);
        return StreamReader(file_).seek(5);
    };
    EXPECT_EQ(reached([](PacketHeader&) {}), 5);
    EXPECT_EQ(reached([](PacketHeader& header) { header.first_row = 3; }), 0);
    EXPECT_EQ(reached([](PacketHeader& header) { header.slot = 6; }), 0);
    EXPECT_EQ(reached([](PacketHeader& header) { header.kind = PacketKind::kIndex; }), 0);
}

}  // namespace
}  // namespace stipple
