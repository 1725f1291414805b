#include <algorithm>
#include <map>

#include "capture/serve/big_endian.h"
#include "capture/serve/gvcp_codec.h"
#include "capture/serve/gvsp_codec.h"
#include "capture/serve/gvsp_sender.h"
#include "tests/fuzz/framed_file.h"
#include "tests/fuzz/require.h"

namespace stipple {
namespace {

using View = std::span<const std::uint8_t>;

/// A client that puts pieces together by their packet ids.
struct Client {
    std::map<std::uint32_t, Bytes> pieces;
    std::uint32_t last = 0;

    void take(const GvspPacket& packet, std::size_t piece_bytes) {
        Bytes bytes(packet.head.begin(),
                    packet.head.begin() + static_cast<std::ptrdiff_t>(packet.head_bytes));
        bytes.insert(bytes.end(), packet.data.begin(), packet.data.end());
        require(bytes.size() >= 8);
        const std::uint32_t id = load_be<std::uint32_t>(&bytes[4]) & 0xFFFFFFU;
        const unsigned kind = bytes[4] & 0xFU;
        require(kind >= 1 && kind <= 3);
        if (kind == 2) last = id;
        if (kind != 3) return;
        require(bytes.size() <= 8 + piece_bytes);
        pieces[id] = Bytes(bytes.begin() + 8, bytes.end());
    }
};

/// However packets are asked for, they add up to the payload.
void check(const GvspBlock& block, const GvcpPacketResend& wanted) {
    Client client;
    for (std::uint32_t i = block.packets(); i > 0; --i)
        client.take(gvsp_packet(block, i - 1), block.piece_bytes);
    const std::uint32_t end = std::min(wanted.last + 1, block.packets());
    for (std::uint32_t i = wanted.first; i < end; ++i)
        client.take(gvsp_packet(block, i, GvspStatus::kResent), block.piece_bytes);
    Bytes payload;
    for (const auto& [id, piece] : client.pieces)
        payload.insert(payload.end(), piece.begin(), piece.end());
    require(payload == block.payload && client.last == block.packets() - 1);
}

}  // namespace
}  // namespace stipple

/// Input: region and chunks that a client has set (8 bytes), its request for packets (12 bytes),
/// and the frame.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    if (size < 20) return 0;
    ServedImage image;
    image.width = 32;
    image.height = 16;
    image.formats = {pixel_format_named("Mono8"), pixel_format_named("Mono12p")};
    GigeStreamSettings settings;
    settings.format = image.formats[data[0] % 2U];
    settings.offset_x = data[1] % 8U * 4U;
    settings.offset_y = data[2] % 16U;
    settings.width = std::max(4U, std::min(data[3] % 32U / 4U * 4U, 32U - settings.offset_x));
    settings.height = std::max(1U, std::min<std::uint32_t>(data[4] % 16U, 16U - settings.offset_y));
    settings.chunk_mode = (data[5] & 1U) != 0;
    for (std::size_t i = 0; i < settings.chunks.size(); ++i)
        settings.chunks[i] = (data[5] >> (i + 1) & 1U) != 0;
    ServedFrame frame;
    frame.payload.assign(data + 20, data + size);
    frame.payload.resize(settings.format->row_bytes(image.width) * 16);
    settings.packet_bytes = kGvspOverheadBytes + 1 + data[7];
    GvspBlock block = served_block(std::move(frame), image, settings, 1);
    block.id = gvsp_block_id(data[6]);
    const auto command =
        decode_gvcp(encode_gvcp_command(GvcpCode::kPacketResend, 1, View(data + 8, 12)));
    check(block, std::get<GvcpPacketResend>(command.value().body));
    return 0;
}
