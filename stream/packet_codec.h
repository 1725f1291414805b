#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace stipple {

/// The values of a stream header on which packets and end marker depend (`framing_of`).
struct Framing {
    int version = 2;
    std::uint32_t seed = 0;  ///< header CRC, from which their CRCs continue; 0 in version 1
};

// The frames around payloads, as bytes (docs/stream_format.md, "Packet" and "End marker").

inline constexpr std::size_t kPacketHeaderBytes = 36;
inline constexpr std::size_t kEndMarkerBytes = 20;
inline constexpr std::uint32_t kMaxPayloadBytes = 1U << 29U;
inline constexpr std::uint64_t kMaxSlot = (std::uint64_t{1} << 53U) - 1;

enum class PacketKind : std::uint8_t { kSamples = 1, kAddressed = 2, kIndex = 3, kSwitch = 4 };

/// The numbers of a packet header, unchecked.
struct PacketHeader {
    PacketKind kind = PacketKind::kSamples;
    std::uint8_t flags = 0;
    std::uint16_t switches = 0;  ///< of the stream up to this packet; 0 before version 4
    std::uint64_t slot = 0;
    std::uint16_t first_row = 0;
    std::uint16_t rows = 0;
    std::uint32_t samples = 0;
    std::uint32_t payload_bytes = 0;
    std::uint32_t payload_crc = 0;
};

/// Length of the end marker; kEndMarkerBytes from version 2 on.
[[nodiscard]] constexpr std::size_t end_marker_bytes(const Framing& framing) {
    return framing.version == 1 ? 16 : kEndMarkerBytes;
}

/// Content of an end marker.
struct EndMarker {
    std::uint64_t index_offset = 0;
    std::optional<std::uint32_t> checksum = std::nullopt;  ///< of all packets; none in version 1
};

/// Writes the first kPacketHeaderBytes of `packet`, with length and CRC of the payload, which is in
/// place. `seed` as in Framing.
void frame_packet(PacketHeader header, std::span<std::uint8_t> packet, std::uint32_t seed);
/// Precondition: `start` of these bytes is kPacket.
[[nodiscard]] PacketHeader decode_packet_header(std::span<const std::uint8_t> bytes);

/// The packet checksum up to `packet`, from the one before it (initially the seed).
[[nodiscard]] std::uint32_t add_to_checksum(std::uint32_t checksum,
                                            std::span<const std::uint8_t> packet);

[[nodiscard]] std::array<std::uint8_t, kEndMarkerBytes> encode_end_marker(
    std::uint64_t index_offset, std::uint32_t checksum, std::uint32_t seed);
/// Precondition: `start` of these bytes is kEnd.
[[nodiscard]] EndMarker decode_end_marker(std::span<const std::uint8_t> bytes,
                                          const Framing& framing);

/// First unit in a part of a file.
enum class Start {
    kPacket,    ///< a packet header with a good CRC, whose payload is not too long
    kEnd,       ///< an end marker with a good CRC
    kCut,       ///< one of the two, but the bytes end within it
    kNoSync,    ///< neither
    kBadCrc,    ///< a sync word with a wrong CRC
    kTooLarge,  ///< a packet header with a payload beyond its limit
};
[[nodiscard]] Start start_of(std::span<const std::uint8_t> bytes, const Framing& framing);

/// Why neither a packet nor an end marker begins, for messages.
[[nodiscard]] std::string_view cause_of(Start start, const Framing& framing);

/// Position of the first whole packet header or end marker with a good CRC; bytes.size() if none.
[[nodiscard]] std::size_t find_start(std::span<const std::uint8_t> bytes, const Framing& framing);

}  // namespace stipple
