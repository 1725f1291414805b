#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stipple {

/// "127.0.0.1" as a number in host byte order; nothing if it is no IPv4 address.
[[nodiscard]] std::optional<std::uint32_t> parse_ipv4(const std::string& text);
[[nodiscard]] std::string ipv4_text(std::uint32_t address);

/// An IPv4 network interface of this machine.
struct NetworkInterface {
    std::string name;
    int index = 0;  ///< by which the kernel numbers interfaces
    std::uint32_t address = 0;
    std::uint32_t netmask = 0xFFFFFF00;
    int mtu = 0;  ///< bytes; 0 where the system does not say (no /sys)
    bool is_up = false;
    bool is_loopback = false;
};

/// All that have an IPv4 address, one entry an address.
[[nodiscard]] std::vector<NetworkInterface> network_interfaces();

/// The interface in whose network `address` lies; nothing if it is none of ours.
[[nodiscard]] std::optional<NetworkInterface> interface_at(std::uint32_t address);

/// The interface that packets for `ip` leave by, as the kernel's routing says; empty if there is no
/// route or `ip` is no IPv4 address.
[[nodiscard]] std::optional<NetworkInterface> interface_towards(const std::string& ip);

}  // namespace stipple
