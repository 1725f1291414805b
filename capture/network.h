#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stipple {

/// "127.0.0.1" as a number in host byte order; empty if it is no IPv4 address.
[[nodiscard]] std::optional<std::uint32_t> parse_ipv4(const std::string& text);
[[nodiscard]] std::string ipv4_text(std::uint32_t address);

/// An IPv4 network interface of this machine.
struct NetworkInterface {
    std::string name;
    int index = 0;  ///< number of the interface in the kernel
    std::uint32_t address = 0;
    std::uint32_t netmask = 0xFFFFFF00;
    int mtu = 0;  ///< bytes; 0 if unknown (no /sys)
    bool is_up = false;
    bool is_loopback = false;
};

/// All interfaces with an IPv4 address, one entry per address.
[[nodiscard]] std::vector<NetworkInterface> network_interfaces();

/// The interface whose subnet contains `address`; empty if there is none.
[[nodiscard]] std::optional<NetworkInterface> interface_at(std::uint32_t address);

/// The interface through which the kernel routes packets to `ip`; empty if there is no route or
/// `ip` is no IPv4 address.
[[nodiscard]] std::optional<NetworkInterface> interface_towards(const std::string& ip);

/// net.core.rmem_max: the largest receive buffer that a program may request, in bytes; 0 if
/// unknown.
[[nodiscard]] std::int64_t rmem_max_bytes();

/// Whether this program may have a receive buffer above net.core.rmem_max (CAP_NET_ADMIN).
[[nodiscard]] bool can_exceed_rmem_max();

/// Datagrams dropped by the full UDP socket bound to `port`; 0 if there is no such socket.
[[nodiscard]] std::uint64_t udp_drops(int port);

/// Number of dropped or damaged frames of an interface plus its link changes.
[[nodiscard]] std::uint64_t link_faults(const std::string& interface);

}  // namespace stipple
