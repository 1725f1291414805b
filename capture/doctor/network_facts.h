#pragma once

#include <cstdint>
#include <string>

namespace stipple {

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
