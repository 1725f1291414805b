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
    /// Whether address and port are set.
    [[nodiscard]] bool is_set() const { return address != 0 && port != 0; }
    bool operator==(const UdpEndpoint&) const = default;
};

struct Datagram {
    std::vector<std::uint8_t> bytes;
    UdpEndpoint from;
    int interface = 0;  ///< on which it was received
};

/// A part of a datagram to be sent: `head`, then `data`.
struct DatagramParts {
    std::span<const std::uint8_t> head;
    std::span<const std::uint8_t> data;
};

class UdpSocket {
  public:
    /// Port 0: any. `shared`: other sockets may bind the same (for broadcast addresses).
    /// \throws std::system_error.
    explicit UdpSocket(UdpEndpoint local, bool shared = false);
    ~UdpSocket();
    UdpSocket(UdpSocket&& other) noexcept;
    UdpSocket& operator=(UdpSocket&&) = delete;

    [[nodiscard]] int descriptor() const { return descriptor_; }
    [[nodiscard]] UdpEndpoint local() const;
    /// A received datagram, or empty. Never waits.
    [[nodiscard]] std::optional<Datagram> receive() const;
    /// Waits for room in the buffer of the socket. Returns whether it was sent; false if it is too
    /// large.
    bool send(UdpEndpoint to, std::span<const std::uint8_t> bytes) const;
    /// The same for several datagrams. Returns the number sent.
    std::size_t send(UdpEndpoint to, std::span<const DatagramParts> datagrams) const;
    /// On: datagrams larger than the MTU fail; off: they are fragmented.
    void set_do_not_fragment(bool on) const;
    void set_send_buffer(int bytes) const;

  private:
    int descriptor_ = -1;
};

}  // namespace stipple
