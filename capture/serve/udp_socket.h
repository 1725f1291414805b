#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stipple {

/// An IPv4 address and a UDP port, both in host byte order.
struct UdpEndpoint {
    std::uint32_t address = 0;
    std::uint16_t port = 0;
    /// Whether it names one receiver.
    [[nodiscard]] bool is_somebody() const { return address != 0 && port != 0; }
    bool operator==(const UdpEndpoint&) const = default;
};

struct Datagram {
    std::vector<std::uint8_t> bytes;
    UdpEndpoint from;
    int interface = 0;  ///< that it came in by
};

/// A part of a datagram to be sent: `head`, then `data`.
struct DatagramParts {
    std::span<const std::uint8_t> head;
    std::span<const std::uint8_t> data;
};

class UdpSocket {
  public:
    /// Port 0: any. `shared`: others may have the same (for broadcast addresses).
    /// \throws std::system_error.
    explicit UdpSocket(UdpEndpoint local, bool shared = false);
    ~UdpSocket();
    UdpSocket(UdpSocket&& other) noexcept;
    UdpSocket& operator=(UdpSocket&&) = delete;

    [[nodiscard]] int descriptor() const { return descriptor_; }
    [[nodiscard]] UdpEndpoint local() const;
    /// A datagram that has come, or nothing. Never waits.
    [[nodiscard]] std::optional<Datagram> receive() const;
    /// Waits for room in the socket's buffer. Whether it was sent: not if it is too large.
    bool send(UdpEndpoint to, std::span<const std::uint8_t> bytes) const;
    /// The same for many. Returns how many were sent.
    std::size_t send(UdpEndpoint to, std::span<const DatagramParts> datagrams) const;
    /// Whether datagrams that are larger than the network takes fail, instead of going in pieces.
    void set_do_not_fragment(bool on) const;
    void set_send_buffer(int bytes) const;

  private:
    int descriptor_ = -1;
};

}  // namespace stipple
