#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

namespace stipple {

// The GigE Vision control protocol (GVCP), as bytes: the part that a device needs. Fields are
// big-endian. A command: 0x42, flags, command (2), length after the header (2), request id (2). A
// reply: status (2), command + 1 (2), length (2), id of the request (2).

inline constexpr std::uint16_t kGvcpPort = 3956;
inline constexpr std::size_t kGvcpHeaderBytes = 8;
/// Payload of a datagram of 576 bytes, without the headers of IP and UDP.
inline constexpr std::size_t kMaxGvcpBytes = 548;
/// Maximum data of one READMEM or WRITEMEM.
inline constexpr std::size_t kMaxGvcpMemoryBytes = 536;

enum class GvcpCode : std::uint16_t {
    kDiscovery = 0x02,
    kPacketResend = 0x40,
    kReadRegister = 0x80,
    kWriteRegister = 0x82,
    kReadMemory = 0x84,
    kWriteMemory = 0x86,
};

enum class GvcpStatus : std::uint16_t {
    kSuccess = 0,
    kNotImplemented = 0x8001,
    kInvalidParameter = 0x8002,
    kInvalidAddress = 0x8003,
    kWriteProtect = 0x8004,
    kBadAlignment = 0x8005,
    kAccessDenied = 0x8006,
    kBusy = 0x8007,
};

struct GvcpDiscovery {};
struct GvcpReadRegisters {
    std::vector<std::uint32_t> addresses;  ///< 1 to 135
};
struct GvcpWriteRegisters {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> writes;  ///< address and value, 1 to 67
};
struct GvcpReadMemory {
    std::uint32_t address = 0;
    std::size_t bytes = 0;  ///< a multiple of 4, up to kMaxGvcpMemoryBytes
};
struct GvcpWriteMemory {
    std::uint32_t address = 0;
    std::vector<std::uint8_t> data;  ///< a multiple of 4, up to kMaxGvcpMemoryBytes
};
/// Request to send packets first..last of a block again.
struct GvcpPacketResend {
    std::uint16_t channel = 0;
    std::uint16_t block = 0;
    std::uint32_t first = 0;  ///< 24 bits
    std::uint32_t last = 0;   ///< 24 bits
};
/// A command that is refused in any state of the device.
struct GvcpRefused {
    GvcpStatus status = GvcpStatus::kNotImplemented;
};

struct GvcpCommand {
    std::uint16_t code = 0;
    std::uint16_t id = 0;
    bool wants_reply = false;
    std::variant<GvcpDiscovery, GvcpReadRegisters, GvcpWriteRegisters, GvcpReadMemory,
                 GvcpWriteMemory, GvcpPacketResend, GvcpRefused>
        body;
};

/// The command in a datagram; empty if it is no GVCP command, which a device does not answer.
[[nodiscard]] std::optional<GvcpCommand> decode_gvcp(std::span<const std::uint8_t> datagram);

/// The reply to a command.
[[nodiscard]] std::vector<std::uint8_t> encode_gvcp_reply(const GvcpCommand& command,
                                                          GvcpStatus status,
                                                          std::span<const std::uint8_t> content);

/// A command in the form that a client sends. Precondition: header and content have at most
/// kMaxGvcpBytes.
[[nodiscard]] std::vector<std::uint8_t> encode_gvcp_command(GvcpCode code, std::uint16_t id,
                                                            std::span<const std::uint8_t> content);

}  // namespace stipple
