#include "capture/serve/udp_socket.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

namespace stipple {
namespace {

constexpr std::size_t kMaxDatagramBytes = 65536;
constexpr std::size_t kBatch = 64;

sockaddr_in to_system(UdpEndpoint endpoint) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(endpoint.port);
    address.sin_addr.s_addr = htonl(endpoint.address);
    return address;
}

UdpEndpoint from_system(const sockaddr_in& address) {
    return {ntohl(address.sin_addr.s_addr), ntohs(address.sin_port)};
}

[[noreturn]] void fail(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
}

void set_option(int descriptor, int level, int option, int value) {
    static_cast<void>(setsockopt(descriptor, level, option, &value, sizeof value));
}

/// The interface by which a datagram came in.
int interface_in(msghdr& message) {
    for (cmsghdr* control = CMSG_FIRSTHDR(&message); control != nullptr;
         control = CMSG_NXTHDR(&message, control))
        if (control->cmsg_level == IPPROTO_IP && control->cmsg_type == IP_PKTINFO)
            return reinterpret_cast<const in_pktinfo*>(CMSG_DATA(control))->ipi_ifindex;
    return 0;
}

}  // namespace

UdpSocket::UdpSocket(UdpEndpoint local, bool shared)
    : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    if (descriptor_ < 0) fail("socket");
    if (shared) set_option(descriptor_, SOL_SOCKET, SO_REUSEADDR, 1);
    set_option(descriptor_, IPPROTO_IP, IP_PKTINFO, 1);
    const sockaddr_in address = to_system(local);
    if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return;
    const int error = errno;
    close(descriptor_);
    errno = error;
    fail("bind");
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

UdpSocket::~UdpSocket() {
    if (descriptor_ >= 0) close(descriptor_);
}

UdpEndpoint UdpSocket::local() const {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    static_cast<void>(getsockname(descriptor_, reinterpret_cast<sockaddr*>(&address), &size));
    return from_system(address);
}

std::optional<Datagram> UdpSocket::receive() const {
    Datagram datagram;
    datagram.bytes.resize(kMaxDatagramBytes);
    sockaddr_in from{};
    iovec part{datagram.bytes.data(), datagram.bytes.size()};
    alignas(cmsghdr) std::array<char, 256> control{};
    msghdr message{};
    message.msg_name = &from;
    message.msg_namelen = sizeof from;
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t size = recvmsg(descriptor_, &message, MSG_DONTWAIT);
    if (size < 0) return {};
    datagram.bytes.resize(static_cast<std::size_t>(size));
    datagram.from = from_system(from);
    datagram.interface = interface_in(message);
    return datagram;
}

bool UdpSocket::send(UdpEndpoint to, std::span<const std::uint8_t> bytes) const {
    const DatagramParts parts{bytes, {}};
    return send(to, std::span(&parts, 1)) == 1;
}

std::size_t UdpSocket::send(UdpEndpoint to, std::span<const DatagramParts> datagrams) const {
    sockaddr_in address = to_system(to);
    std::array<iovec, 2 * kBatch> parts{};
    std::array<mmsghdr, kBatch> messages{};
    const std::size_t count = std::min(datagrams.size(), kBatch);
    const auto iovec_of = [](std::span<const std::uint8_t> bytes) {
        return iovec{const_cast<std::uint8_t*>(bytes.data()), bytes.size()};
    };
    for (std::size_t i = 0; i < count; ++i) {
        parts[2 * i] = iovec_of(datagrams[i].head);
        parts[2 * i + 1] = iovec_of(datagrams[i].data);
        messages[i].msg_hdr.msg_name = &address;
        messages[i].msg_hdr.msg_namelen = sizeof address;
        messages[i].msg_hdr.msg_iov = &parts[2 * i];
        messages[i].msg_hdr.msg_iovlen = datagrams[i].data.empty() ? 1 : 2;
    }
    std::size_t sent = 0;
    for (std::size_t done = 0; done < count;) {
        const int n =
            sendmmsg(descriptor_, &messages[done], static_cast<unsigned>(count - done), 0);
        if (n < 0 && errno == EINTR) continue;
        // One that cannot be sent (refused, too large) is passed over, as the network would.
        done += n < 0 ? 1 : static_cast<std::size_t>(n);
        sent += n < 0 ? 0 : static_cast<std::size_t>(n);
    }
    return datagrams.size() > count ? sent + send(to, datagrams.subspan(count)) : sent;
}

void UdpSocket::set_do_not_fragment(bool on) const {
    set_option(descriptor_, IPPROTO_IP, IP_MTU_DISCOVER, on ? IP_PMTUDISC_DO : IP_PMTUDISC_DONT);
}

void UdpSocket::set_send_buffer(int bytes) const {
    set_option(descriptor_, SOL_SOCKET, SO_SNDBUF, bytes);
}

}  // namespace stipple
