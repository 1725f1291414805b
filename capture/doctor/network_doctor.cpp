#include "capture/doctor/doctor_findings.h"

#include <fmt/format.h>

#include "capture/network.h"

namespace stipple {
namespace {

using Level = DoctorFinding::Level;

/// Four frames of 2 Mpixel of 16 bits.
constexpr std::int64_t kComfortableBufferBytes = std::int64_t{16} << 20U;
constexpr int kEthernetMtu = 1500;
constexpr int kJumboMtu = 9000;

}  // namespace

DoctorFinding judge_receive_buffer(std::int64_t max_bytes, bool may_exceed) {
    const double mib = static_cast<double>(max_bytes) / (1 << 20U);
    DoctorFinding finding{Level::kGood, "receive buffer",
                          fmt::format("net.core.rmem_max is {:.1f} MiB", mib), ""};
    if (max_bytes == 0) finding.fact = "net.core.rmem_max cannot be read";
    if (may_exceed) {
        finding.fact += "; this program may exceed it";
        return finding;
    }
    if (max_bytes >= kComfortableBufferBytes) return finding;
    finding.level = Level::kWarning;
    finding.fix = fmt::format(
        "sysctl -w net.core.rmem_max={} (to stay: a file in sysctl.d), or "
        "setcap cap_net_admin+ep on the program",
        kComfortableBufferBytes);
    return finding;
}

DoctorFinding judge_mtu(const std::string& interface, int mtu) {
    DoctorFinding finding{Level::kGood, fmt::format("MTU of {}", interface),
                          fmt::format("{} bytes", mtu), ""};
    if (mtu >= kJumboMtu) return finding;
    finding.level = mtu < kEthernetMtu ? Level::kProblem : Level::kWarning;
    finding.fact += mtu < kEthernetMtu ? ", less than Ethernet's" : ", no jumbo frames";
    finding.fix = fmt::format("ip link set {} mtu {} (the switch and the camera must take it too)",
                              interface, mtu < kEthernetMtu ? kEthernetMtu : kJumboMtu);
    return finding;
}

std::vector<DoctorFinding> examine_network(const std::string& address) {
    std::vector<DoctorFinding> findings;
    const bool may_exceed = can_exceed_rmem_max();
    const auto path = address.empty() ? std::nullopt : interface_towards(address.substr(5));
    for (const NetworkInterface& interface : network_interfaces()) {
        if (path && path->name != interface.name) continue;
        DoctorFinding finding{
            Level::kGood, fmt::format("interface {}", interface.name),
            fmt::format("{} / {}, {}", ipv4_text(interface.address), ipv4_text(interface.netmask),
                        interface.is_up ? "up" : "down"),
            ""};
        if (!interface.is_up) {
            finding.level = Level::kWarning;
            finding.fix = fmt::format("ip link set {} up", interface.name);
        }
        findings.push_back(finding);
        if (!interface.is_loopback && interface.mtu > 0)
            findings.push_back(judge_mtu(interface.name, interface.mtu));
    }
    if (findings.empty())
        findings.push_back({Level::kWarning, "interfaces", "none has an IPv4 address",
                            "ip addr add 192.168.0.1/24 dev IF for a camera that is plugged in "
                            "directly"});
    findings.push_back({Level::kFact, "CAP_NET_ADMIN",
                        may_exceed ? "held: receive buffers of any size"
                                   : "not held: receive buffers up to net.core.rmem_max",
                        ""});
    findings.push_back(judge_receive_buffer(rmem_max_bytes(), may_exceed));
    return findings;
}

}  // namespace stipple
