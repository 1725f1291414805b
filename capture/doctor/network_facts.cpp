#include "capture/doctor/network_doctor.h"

#include <sys/socket.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace stipple {

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
