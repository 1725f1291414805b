#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stipple {

/// An IPv4 network interface of this machine.
struct NetworkInterface {
    std::string name;
    std::string address;
    std::string netmask;
    int mtu = 0;  ///< bytes; 0 where the system does not say (no /sys)
    bool is_up = false;
    bool is_loopback = false;
};

/// All that have an IPv4 address, one entry an address.
[[nodiscard]] std::vector<NetworkInterface> network_interfaces();

/// The interface that packets for `ip` leave by, as the kernel's routing says; empty if there is no
/// route or `ip` is no IPv4 address.
[[nodiscard]] std::optional<NetworkInterface> interface_towards(const std::string& ip);

/// net.core.rmem_max: the largest receive buffer in bytes that a program may ask for; 0 if unknown.
[[nodiscard]] std::int64_t rmem_max_bytes();

/// Whether this program may open packet sockets (CAP_NET_RAW), which need no receive buffer.
[[nodiscard]] bool can_open_packet_socket();

/// Datagrams that the UDP socket bound to `port` had no room for; 0 if there is no such socket.
[[nodiscard]] std::uint64_t udp_drops(int port);

/// Frames that an interface had to drop or found damaged, and times that its link came or went.
[[nodiscard]] std::uint64_t link_faults(const std::string& interface);

}  // namespace stipple
