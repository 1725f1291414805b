#pragma once

#include <cstdint>
#include <string>

namespace stipple {

/// net.core.rmem_max: the largest receive buffer in bytes that a program may ask for; 0 if unknown.
[[nodiscard]] std::int64_t rmem_max_bytes();

/// Whether this program may open packet sockets (CAP_NET_RAW), which need no receive buffer.
[[nodiscard]] bool can_open_packet_socket();

/// Datagrams that the UDP socket bound to `port` had no room for; 0 if there is no such socket.
[[nodiscard]] std::uint64_t udp_drops(int port);

/// Frames that an interface had to drop or found damaged, and times that its link came or went.
[[nodiscard]] std::uint64_t link_faults(const std::string& interface);

}  // namespace stipple
