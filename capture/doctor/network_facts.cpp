#include "capture/doctor/network_facts.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>

namespace stipple {
namespace {

/// A socket that closes itself.
class Socket {
  public:
    Socket(int domain, int type) : descriptor_(::socket(domain, type | SOCK_CLOEXEC, 0)) {}
    ~Socket() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;
    [[nodiscard]] int get() const { return descriptor_; }

  private:
    int descriptor_;
};

std::string text_of(const sockaddr* address) {
    if (address == nullptr || address->sa_family != AF_INET) return {};
    sockaddr_in ipv4{};
    std::memcpy(&ipv4, address, sizeof ipv4);
    std::array<char, INET_ADDRSTRLEN> text{};
    inet_ntop(AF_INET, &ipv4.sin_addr, text.data(), text.size());
    return text.data();
}

int mtu_of(const std::string& name) {
    std::ifstream file("/sys/class/net/" + name + "/mtu");
    int mtu = 0;
    file >> mtu;
    return mtu;
}

}  // namespace

std::vector<NetworkInterface> network_interfaces() {
    std::vector<NetworkInterface> found;
    ifaddrs* list = nullptr;
    if (getifaddrs(&list) != 0) return found;
    for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
        const std::string address = text_of(entry->ifa_addr);
        if (address.empty()) continue;
        found.push_back({entry->ifa_name, address, text_of(entry->ifa_netmask),
                         mtu_of(entry->ifa_name), (entry->ifa_flags & IFF_UP) != 0,
                         (entry->ifa_flags & IFF_LOOPBACK) != 0});
    }
    freeifaddrs(list);
    return found;
}

std::optional<NetworkInterface> interface_towards(const std::string& ip) {
    sockaddr_in target{};
    target.sin_family = AF_INET;
    target.sin_port = htons(3956);
    if (inet_pton(AF_INET, ip.c_str(), &target.sin_addr) != 1) return std::nullopt;
    // connect() of a UDP socket sends nothing, but picks the address to send from.
    const Socket socket(AF_INET, SOCK_DGRAM);
    sockaddr address{};
    std::memcpy(&address, &target, sizeof target);
    socklen_t size = sizeof address;
    if (::connect(socket.get(), &address, size) != 0 ||
        ::getsockname(socket.get(), &address, &size) != 0)
        return std::nullopt;
    const std::string own = text_of(&address);
    const auto all = network_interfaces();
    const auto match = std::find_if(all.begin(), all.end(), [&](const NetworkInterface& one) {
        return one.address == own || (one.is_loopback && own.starts_with("127."));
    });
    return match == all.end() ? std::nullopt : std::optional(*match);
}

std::int64_t rmem_max_bytes() {
    std::ifstream file("/proc/sys/net/core/rmem_max");
    std::int64_t bytes = 0;
    file >> bytes;
    return bytes;
}

bool can_open_packet_socket() {
    return Socket(AF_PACKET, SOCK_RAW).get() >= 0;
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
