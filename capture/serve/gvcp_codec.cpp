#include "capture/serve/gvcp_codec.h"

#include "capture/serve/big_endian.h"

namespace stipple {
namespace {

constexpr std::uint8_t kCommandKey = 0x42;
constexpr std::uint8_t kAcknowledge = 0x01;
constexpr std::uint8_t kExtendedIds = 0x10;  ///< of PACKETRESEND: block ids of 64 bits
constexpr std::uint32_t kPacketIdMask = 0xFFFFFF;

using Bytes = std::span<const std::uint8_t>;
using Body = decltype(GvcpCommand::body);

std::uint32_t word(Bytes bytes, std::size_t at) {
    return load_be<std::uint32_t>(&bytes[at]);
}

Body read_registers(Bytes content) {
    GvcpReadRegisters read;
    for (std::size_t at = 0; at < content.size(); at += 4)
        read.addresses.push_back(word(content, at));
    return read;
}

Body write_registers(Bytes content) {
    GvcpWriteRegisters write;
    for (std::size_t at = 0; at < content.size(); at += 8)
        write.writes.emplace_back(word(content, at), word(content, at + 4));
    return write;
}

Body read_memory(Bytes content) {
    const std::size_t bytes = load_be<std::uint16_t>(&content[6]);
    if (bytes == 0 || bytes > kMaxGvcpMemoryBytes)
        return GvcpRefused{GvcpStatus::kInvalidParameter};
    if (bytes % 4 != 0) return GvcpRefused{GvcpStatus::kBadAlignment};
    return GvcpReadMemory{word(content, 0), bytes};
}

Body write_memory(Bytes content) {
    if (content.size() % 4 != 0) return GvcpRefused{GvcpStatus::kBadAlignment};
    return GvcpWriteMemory{word(content, 0), {content.begin() + 4, content.end()}};
}

Body packet_resend(Bytes content) {
    return GvcpPacketResend{load_be<std::uint16_t>(content.data()),
                            load_be<std::uint16_t>(&content[2]), word(content, 4) & kPacketIdMask,
                            word(content, 8) & kPacketIdMask};
}

Body decode_body(GvcpCode code, std::uint8_t flags, Bytes content) {
    constexpr GvcpRefused kMalformed{GvcpStatus::kInvalidParameter};
    const std::size_t size = content.size();
    const bool some_words = size >= 4 && size % 4 == 0;
    switch (code) {
        case GvcpCode::kDiscovery:
            return size == 0 ? Body(GvcpDiscovery{}) : kMalformed;
        case GvcpCode::kReadRegister:
            return some_words ? read_registers(content) : kMalformed;
        case GvcpCode::kWriteRegister:
            return some_words && size % 8 == 0 ? write_registers(content) : kMalformed;
        case GvcpCode::kReadMemory:
            return size == 8 ? read_memory(content) : kMalformed;
        case GvcpCode::kWriteMemory:
            return size > 4 ? write_memory(content) : kMalformed;
        case GvcpCode::kPacketResend:
            if ((flags & kExtendedIds) != 0) return GvcpRefused{GvcpStatus::kNotImplemented};
            return size == 12 ? packet_resend(content) : kMalformed;
    }
    return GvcpRefused{GvcpStatus::kNotImplemented};
}

}  // namespace

std::optional<GvcpCommand> decode_gvcp(Bytes datagram) {
    if (datagram.size() < kGvcpHeaderBytes || datagram.size() > kMaxGvcpBytes) return {};
    if (datagram[0] != kCommandKey) return {};
    GvcpCommand command;
    command.wants_reply = (datagram[1] & kAcknowledge) != 0;
    command.code = load_be<std::uint16_t>(&datagram[2]);
    command.id = load_be<std::uint16_t>(&datagram[6]);
    const std::size_t size = load_be<std::uint16_t>(&datagram[4]);
    if (size > datagram.size() - kGvcpHeaderBytes) return {};
    command.body = decode_body(static_cast<GvcpCode>(command.code), datagram[1],
                               datagram.subspan(kGvcpHeaderBytes, size));
    return command;
}

std::vector<std::uint8_t> encode_gvcp_reply(const GvcpCommand& command, GvcpStatus status,
                                            Bytes content) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(kGvcpHeaderBytes + content.size());
    append_be(bytes, static_cast<std::uint16_t>(status));
    append_be(bytes, static_cast<std::uint16_t>(command.code + 1U));
    append_be(bytes, static_cast<std::uint16_t>(content.size()));
    append_be(bytes, command.id);
    bytes.insert(bytes.end(), content.begin(), content.end());
    return bytes;
}

std::vector<std::uint8_t> encode_gvcp_command(GvcpCode code, std::uint16_t id, Bytes content) {
    std::vector<std::uint8_t> bytes{kCommandKey, kAcknowledge};
    append_be(bytes, static_cast<std::uint16_t>(code));
    append_be(bytes, static_cast<std::uint16_t>(content.size()));
    append_be(bytes, id);
    bytes.insert(bytes.end(), content.begin(), content.end());
    return bytes;
}

}  // namespace stipple
