#include "capture/aravis/gige_link.h"

#include <arpa/inet.h>
#include <linux/filter.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <system_error>

namespace stipple {
namespace {

// Offsets of the filter count from the header of UDP.
constexpr std::uint32_t kUdpHeader = 8;
constexpr std::uint32_t kSource = static_cast<std::uint32_t>(SKF_NET_OFF) + 12;  // in that of IP
constexpr std::uint32_t kFormat = kUdpHeader + 4;  // flag of extended ids, kind of packet
constexpr std::uint32_t kExtended = 0x80;
constexpr std::uint32_t kLeader = 1;
constexpr std::uint32_t kTrailer = 2;
constexpr std::uint32_t kPayload = 3;
constexpr std::uint32_t kMultipart = 0x0A;  // payload type in a leader

constexpr std::uint16_t kLoadByte = BPF_LD | BPF_B | BPF_ABS;
constexpr std::uint16_t kLoadHalf = BPF_LD | BPF_H | BPF_ABS;
constexpr std::uint16_t kLoadWord = BPF_LD | BPF_W | BPF_ABS;
constexpr std::uint16_t kAnd = BPF_ALU | BPF_AND | BPF_K;
constexpr std::uint16_t kIfEqual = BPF_JMP | BPF_JEQ | BPF_K;
constexpr std::uint16_t kIfMore = BPF_JMP | BPF_JGT | BPF_K;

}  // namespace

int udp_socket_at(UdpEndpoint local) {
    std::error_code unreadable;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", unreadable)) {
        const int socket = std::stoi(entry.path().filename().string());
        sockaddr_in bound{};
        socklen_t bytes = sizeof bound;
        int type = 0;
        socklen_t type_bytes = sizeof type;
        if (getsockname(socket, reinterpret_cast<sockaddr*>(&bound), &bytes) == 0 &&
            bound.sin_family == AF_INET && ntohl(bound.sin_addr.s_addr) == local.address &&
            ntohs(bound.sin_port) == local.port &&
            getsockopt(socket, SOL_SOCKET, SO_TYPE, &type, &type_bytes) == 0 && type == SOCK_DGRAM)
            return socket;
    }
    return -1;
}

bool filter_gvsp(int socket, const GvspAgreement& agreed) {
    const std::uint32_t header = agreed.extended_ids ? 20 : 8;
    const std::size_t piece =
        agreed.packet_bytes - std::min<std::size_t>(agreed.packet_bytes - 1, 28 + header);
    const auto last_id = static_cast<std::uint32_t>((agreed.payload_bytes + piece - 1) / piece + 1);
    const std::uint32_t packet_id = kUdpHeader + (agreed.extended_ids ? 16 : 4);
    const std::uint32_t id_bits = agreed.extended_ids ? 0xFFFFFFFF : 0x00FFFFFF;
    const std::uint32_t format = agreed.extended_ids ? kExtended : 0;
    // Each test that fails jumps to the last line: so many lines are between.
    std::array<sock_filter, 16> program{{
        {kLoadWord, 0, 0, kSource},
        {kIfEqual, 0, 13, agreed.camera},
        {BPF_LD | BPF_W | BPF_LEN, 0, 0, 0},
        {kIfMore, 0, 11, kUdpHeader + header},
        {kLoadWord, 0, 0, packet_id},
        {kAnd, 0, 0, id_bits},
        {kIfMore, 8, 0, last_id},
        {kLoadByte, 0, 0, kFormat},
        {kIfEqual, 5, 0, format | kPayload},
        {kIfEqual, 4, 0, format | kTrailer},
        {kIfEqual, 0, 4, format | kLeader},
        {kLoadHalf, 0, 0, kUdpHeader + header + 2},
        {kAnd, 0, 0, 0xFF},
        {kIfEqual, 1, 0, kMultipart},
        {BPF_RET | BPF_K, 0, 0, 0xFFFFFFFF},
        {BPF_RET | BPF_K, 0, 0, 0},
    }};
    const sock_fprog code{program.size(), program.data()};
    if (setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &code, sizeof code) != 0) return false;
    char byte = 0;
    // As many as a receive buffer may hold of those that came before; a camera may go on sending.
    for (int i = 0; i < 1 << 20U && recv(socket, &byte, 1, MSG_DONTWAIT | MSG_TRUNC) >= 0; ++i) {
    }
    return true;
}

}  // namespace stipple
