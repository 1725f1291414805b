#include "capture/network.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <sstream>

namespace stipple {
namespace {

constexpr std::uint16_t kAnyPort = 9;  // discard; nothing is sent

/// 0 if it is no IPv4 address.
std::uint32_t address_of(const sockaddr* address) {
    if (address == nullptr || address->sa_family != AF_INET) return 0;
    sockaddr_in ipv4{};
    std::memcpy(&ipv4, address, sizeof ipv4);
    return ntohl(ipv4.sin_addr.s_addr);
}

int mtu_of(const std::string& name) {
    std::ifstream file("/sys/class/net/" + name + "/mtu");
    int mtu = 0;
    file >> mtu;
    return mtu;
}

template <typename Predicate>
std::optional<NetworkInterface> first_interface(const Predicate& wanted) {
    const auto all = network_interfaces();
    const auto match = std::find_if(all.begin(), all.end(), wanted);
    return match == all.end() ? std::nullopt : std::optional(*match);
}

/// The address that the kernel sends from to `target`; 0 if it has no route.
std::uint32_t source_towards(std::uint32_t target) {
    const int descriptor = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (descriptor < 0) return 0;
    sockaddr_in ipv4{};
    ipv4.sin_family = AF_INET;
    ipv4.sin_port = htons(kAnyPort);
    ipv4.sin_addr.s_addr = htonl(target);
    sockaddr address{};
    std::memcpy(&address, &ipv4, sizeof ipv4);
    socklen_t size = sizeof address;
    // connect() of a UDP socket sends nothing, but picks the address to send from.
    const bool known = ::connect(descriptor, &address, size) == 0 &&
                       ::getsockname(descriptor, &address, &size) == 0;
    ::close(descriptor);
    return known ? address_of(&address) : 0;
}

}  // namespace

std::optional<std::uint32_t> parse_ipv4(const std::string& text) {
    in_addr address{};
    const bool is_c_text = text.find('\0') == std::string::npos;
    if (!is_c_text || inet_pton(AF_INET, text.c_str(), &address) != 1) return {};
    return ntohl(address.s_addr);
}

std::string ipv4_text(std::uint32_t address) {
    const in_addr system{htonl(address)};
    std::array<char, INET_ADDRSTRLEN> text{};
    static_cast<void>(inet_ntop(AF_INET, &system, text.data(), text.size()));
    return text.data();
}

std::vector<NetworkInterface> network_interfaces() {
    std::vector<NetworkInterface> found;
    ifaddrs* list = nullptr;
    if (getifaddrs(&list) != 0) return found;
    for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
        const std::uint32_t address = address_of(entry->ifa_addr);
        if (address == 0) continue;
        found.push_back({.name = entry->ifa_name,
                         .index = static_cast<int>(if_nametoindex(entry->ifa_name)),
                         .address = address,
                         .netmask = address_of(entry->ifa_netmask),
                         .mtu = mtu_of(entry->ifa_name),
                         .is_up = (entry->ifa_flags & IFF_UP) != 0,
                         .is_loopback = (entry->ifa_flags & IFF_LOOPBACK) != 0});
    }
    freeifaddrs(list);
    return found;
}

std::optional<NetworkInterface> interface_at(std::uint32_t address) {
    return first_interface([&](const NetworkInterface& one) {
        return (one.address & one.netmask) == (address & one.netmask);
    });
}

std::optional<NetworkInterface> interface_towards(const std::string& ip) {
    const auto target = parse_ipv4(ip);
    if (!target) return std::nullopt;
    const std::uint32_t own = source_towards(*target);
    if (own == 0) return std::nullopt;
    const bool to_itself = own >> 24U == 127;
    return first_interface([&](const NetworkInterface& one) {
        return one.address == own || (one.is_loopback && to_itself);
    });
}

std::int64_t rmem_max_bytes() {
    std::ifstream file("/proc/sys/net/core/rmem_max");
    std::int64_t bytes = 0;
    file >> bytes;
    return bytes;
}

bool can_exceed_rmem_max() {
    const int descriptor = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (descriptor < 0) return false;
    constexpr int kBytes = 1 << 16;
    const bool can =
        ::setsockopt(descriptor, SOL_SOCKET, SO_RCVBUFFORCE, &kBytes, sizeof kBytes) == 0;
    ::close(descriptor);
    return can;
}

std::uint64_t udp_drops(int port) {
    // "sl local_address rem_address st ... drops", local_address as hex IP:PORT.
    std::ifstream file("/proc/net/udp");
    std::uint64_t drops = 0;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string word;
        std::string local;
        words >> word >> local;
        const auto colon = local.find(':');
        int found = 0;
        if (colon == std::string::npos ||
            std::from_chars(local.data() + colon + 1, local.data() + local.size(), found, 16).ec !=
                std::errc() ||
            found != port)
            continue;
        while (words >> word) {
        }
        drops += std::strtoull(word.c_str(), nullptr, 10);
    }
    return drops;
}

std::uint64_t link_faults(const std::string& interface) {
    std::uint64_t faults = 0;
    for (const char* const counter : {"statistics/rx_dropped", "statistics/rx_errors",
                                      "statistics/rx_missed_errors", "carrier_changes"}) {
        std::ifstream file("/sys/class/net/" + interface + "/" + counter);
        std::uint64_t count = 0;
        if (file >> count) faults += count;
    }
    return faults;
}

}  // namespace stipple
