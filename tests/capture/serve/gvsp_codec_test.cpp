#include "capture/serve/gvsp_codec.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const GvspPacket& packet) {
    Bytes bytes(packet.head.begin(),
                packet.head.begin() + static_cast<std::ptrdiff_t>(packet.head_bytes));
    bytes.insert(bytes.end(), packet.data.begin(), packet.data.end());
    return bytes;
}

GvspBlock block_of(std::size_t bytes, std::size_t piece) {
    GvspBlock block;
    block.id = 0xABCD;
    block.timestamp = 0x0102030405060708;
    block.image = {0x01080001, 640, 480, 16, 32};
    block.payload.resize(bytes);
    std::iota(block.payload.begin(), block.payload.end(), std::uint8_t{0});
    block.piece_bytes = piece;
    return block;
}

TEST(GvspCodecTest, TheLeaderTellsTheImage) {
    EXPECT_EQ(bytes_of(gvsp_packet(block_of(10, 4), 0)),
              (Bytes{0,    0, 0xAB, 0xCD, 1, 0, 0,    0,     // OK, block, leader, packet 0
                     0,    0, 0,    1,                       // image
                     1,    2, 3,    4,    5, 6, 7,    8,     // time
                     0x01, 8, 0,    1,                       // Mono8
                     0,    0, 0x02, 0x80, 0, 0, 0x01, 0xE0,  // 640 x 480
                     0,    0, 0,    16,   0, 0, 0,    32,    // offset
                     0,    0, 0,    0}));                    // padding
}

TEST(GvspCodecTest, TheTrailerTellsTheRows) {
    const GvspBlock block = block_of(10, 4);
    ASSERT_EQ(block.packets(), 5U);
    EXPECT_EQ(bytes_of(gvsp_packet(block, 4)),
              (Bytes{0, 0, 0xAB, 0xCD, 2, 0, 0, 4, 0, 0, 0, 1, 0, 0, 0x01, 0xE0}));
}

TEST(GvspCodecTest, ChunksAreAnnouncedInLeaderAndTrailer) {
    GvspBlock block = block_of(10, 4);
    block.has_chunks = true;
    EXPECT_EQ(bytes_of(gvsp_packet(block, 0))[10], 0x40);
    EXPECT_EQ(bytes_of(gvsp_packet(block, 4))[10], 0x40);
}

TEST(GvspCodecTest, PiecesMakeUpThePayload) {
    for (const std::size_t bytes : {1U, 3U, 4U, 5U, 8U, 1001U}) {
        const GvspBlock block = block_of(bytes, 4);
        Bytes payload;
        for (std::uint32_t i = 1; i + 1 < block.packets(); ++i) {
            const Bytes packet = bytes_of(gvsp_packet(block, i));
            EXPECT_EQ(packet[4], 3);
            EXPECT_EQ(packet[6] << 8 | packet[7], static_cast<int>(i));
            EXPECT_LE(packet.size(), 8 + 4U);
            payload.insert(payload.end(), packet.begin() + 8, packet.end());
        }
        EXPECT_EQ(payload, block.payload) << bytes;
    }
}

TEST(GvspCodecTest, ResentAndUnavailablePacketsSaySo) {
    EXPECT_EQ(bytes_of(gvsp_packet(block_of(10, 4), 2, GvspStatus::kResent))[0], 0x01);
    EXPECT_EQ(bytes_of(gvsp_unavailable(7, 9)), (Bytes{0x80, 0x0C, 0, 7, 3, 0, 0, 9}));
}

TEST(GvspCodecTest, BlockIdsSkipZeroAndWrap) {
    EXPECT_EQ(gvsp_block_id(0), 1);
    EXPECT_EQ(gvsp_block_id(65534), 65535);
    EXPECT_EQ(gvsp_block_id(65535), 1);
    EXPECT_EQ(gvsp_block_id(0, 65530), 65530);
    EXPECT_EQ(gvsp_block_id(5, 65530), 65535);
    EXPECT_EQ(gvsp_block_id(6, 65530), 1);
    std::set<std::uint16_t> ids;
    for (std::uint64_t i = 0; i < 65535; ++i) ids.insert(gvsp_block_id(1000 + i, 300));
    EXPECT_EQ(ids.size(), 65535U);
    EXPECT_EQ(ids.count(0), 0U);
}

TEST(GvspCodecTest, ATestPacketFillsItsSize) {
    for (const std::size_t size : {36U, 128U, 1500U, 9000U})
        EXPECT_EQ(gvsp_test_packet(size).size(), size - 28);
}

TEST(GvspCodecTest, AChunkIsFollowedByItsIdAndLength) {
    Bytes payload{1, 2, 3, 4};
    close_chunk(payload, 0x1001, 4);
    EXPECT_EQ(payload, (Bytes{1, 2, 3, 4, 0, 0, 0x10, 0x01, 0, 0, 0, 4}));
}

}  // namespace
}  // namespace stipple
