#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace stipple {

// The GigE Vision streaming protocol (GVSP), as bytes. A block (a frame) is sent as a leader, its
// payload in pieces, and a trailer; block ids have 16 bits and skip 0. Fields are big-endian:
// status (2), block id (2), kind (1), packet id within the block (3).

/// Headers of IP, UDP and GVSP; the packet size of a stream channel includes them.
inline constexpr std::size_t kGvspOverheadBytes = 20 + 8 + 8;

/// Description of an image in the leader. Region in pixels of the sensor.
struct GvspImage {
    std::uint32_t pixel_format = 0;  ///< PFNC code
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t offset_x = 0;
    std::uint32_t offset_y = 0;
};

/// A frame ready to be cut into packets.
struct GvspBlock {
    std::uint16_t id = 1;  ///< 1 to 65535
    std::uint64_t timestamp = 0;
    GvspImage image;
    bool has_chunks = false;
    std::vector<std::uint8_t> payload;  ///< the image, then the chunks
    std::size_t piece_bytes = 1;        ///< payload bytes in a packet, at least 1

    /// Leader, pieces and trailer.
    [[nodiscard]] std::uint32_t packets() const;
};

enum class GvspStatus : std::uint16_t {
    kSuccess = 0,
    kResent = 0x0100,
    kPacketUnavailable = 0x800C,
};

/// A packet: `head`, then `data` (in the memory of the block).
struct GvspPacket {
    std::array<std::uint8_t, 8 + 36> head = {};
    std::size_t head_bytes = 0;
    std::span<const std::uint8_t> data;
};

/// Packet `index` (below block.packets()) of a block, which must outlive it.
[[nodiscard]] GvspPacket gvsp_packet(const GvspBlock& block, std::uint32_t index,
                                     GvspStatus status = GvspStatus::kSuccess);

/// The answer to a request for a packet that is no longer in the history.
[[nodiscard]] GvspPacket gvsp_unavailable(std::uint16_t block, std::uint32_t index);

/// The UDP payload of a test packet of `packet_bytes` (with the headers of IP and UDP, at least
/// kGvspOverheadBytes).
[[nodiscard]] std::vector<std::uint8_t> gvsp_test_packet(std::size_t packet_bytes);

/// The block id of frame `number` (from 0) in a stream whose first id is `first` (1 to 65535).
[[nodiscard]] std::uint16_t gvsp_block_id(std::uint64_t number, std::uint16_t first = 1);

/// Makes a chunk of the last `bytes` bytes of a payload: appends its id and length. Clients read
/// chunks from the end of the payload.
void close_chunk(std::vector<std::uint8_t>& payload, std::uint32_t id, std::size_t bytes);

}  // namespace stipple
