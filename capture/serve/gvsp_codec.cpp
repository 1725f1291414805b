#include "capture/serve/gvsp_codec.h"

#include <algorithm>
#include <cassert>

#include "capture/serve/big_endian.h"

namespace stipple {
namespace {

constexpr std::size_t kHeaderBytes = 8;
constexpr std::size_t kLeaderBytes = 36;
constexpr std::size_t kTrailerBytes = 8;
constexpr std::uint16_t kImagePayload = 0x0001;
constexpr std::uint16_t kChunksFollow = 0x4000;

enum class Kind : std::uint8_t { kLeader = 1, kTrailer = 2, kPiece = 3 };

GvspPacket begin(std::uint16_t block, std::uint32_t index, Kind kind, GvspStatus status) {
    GvspPacket packet;
    packet.head_bytes = kHeaderBytes;
    store_be(packet.head.data(), static_cast<std::uint16_t>(status));
    store_be(&packet.head[2], block);
    store_be(&packet.head[4], static_cast<std::uint32_t>(kind) << 24U | index);
    return packet;
}

std::uint16_t payload_type(const GvspBlock& block) {
    return block.has_chunks ? kImagePayload | kChunksFollow : kImagePayload;
}

void fill_leader(const GvspBlock& block, GvspPacket& packet) {
    std::uint8_t* leader = &packet.head[kHeaderBytes];
    packet.head_bytes += kLeaderBytes;
    store_be(leader + 2, payload_type(block));
    store_be(leader + 4, block.timestamp);
    store_be(leader + 12, block.image.pixel_format);
    store_be(leader + 16, block.image.width);
    store_be(leader + 20, block.image.height);
    store_be(leader + 24, block.image.offset_x);
    store_be(leader + 28, block.image.offset_y);
}

void fill_trailer(const GvspBlock& block, GvspPacket& packet) {
    std::uint8_t* trailer = &packet.head[kHeaderBytes];
    packet.head_bytes += kTrailerBytes;
    store_be(trailer + 2, payload_type(block));
    store_be(trailer + 4, block.image.height);
}

}  // namespace

std::uint32_t GvspBlock::packets() const {
    return static_cast<std::uint32_t>(2 + (payload.size() + piece_bytes - 1) / piece_bytes);
}

GvspPacket gvsp_packet(const GvspBlock& block, std::uint32_t index, GvspStatus status) {
    assert(index < block.packets());
    if (index == 0) {
        GvspPacket packet = begin(block.id, index, Kind::kLeader, status);
        fill_leader(block, packet);
        return packet;
    }
    if (index + 1 == block.packets()) {
        GvspPacket packet = begin(block.id, index, Kind::kTrailer, status);
        fill_trailer(block, packet);
        return packet;
    }
    GvspPacket packet = begin(block.id, index, Kind::kPiece, status);
    const std::size_t at = (index - 1) * block.piece_bytes;
    packet.data = std::span(block.payload)
                      .subspan(at, std::min(block.piece_bytes, block.payload.size() - at));
    return packet;
}

GvspPacket gvsp_unavailable(std::uint16_t block, std::uint32_t index) {
    return begin(block, index, Kind::kPiece, GvspStatus::kPacketUnavailable);
}

std::vector<std::uint8_t> gvsp_test_packet(std::size_t packet_bytes) {
    const GvspPacket head = begin(0, 0, Kind::kPiece, GvspStatus::kSuccess);
    std::vector<std::uint8_t> bytes(head.head.begin(), head.head.begin() + kHeaderBytes);
    bytes.resize(std::max(packet_bytes, kGvspOverheadBytes) - (kGvspOverheadBytes - kHeaderBytes));
    for (std::size_t i = kHeaderBytes; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::uint8_t>(i);
    return bytes;
}

std::uint16_t gvsp_block_id(std::uint64_t number, std::uint16_t first) {
    constexpr std::uint64_t kIds = 65535;
    return static_cast<std::uint16_t>((number % kIds + first - 1U) % kIds + 1);
}

void close_chunk(std::vector<std::uint8_t>& payload, std::uint32_t id, std::size_t bytes) {
    append_be(payload, id);
    append_be(payload, static_cast<std::uint32_t>(bytes));
}

}  // namespace stipple
