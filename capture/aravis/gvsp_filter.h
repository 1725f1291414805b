#pragma once

#include <cstddef>
#include <cstdint>

#include "capture/serve/udp_socket.h"

namespace stipple {

/// What a stream of GigE Vision has agreed on.
struct GvspAgreement {
    std::uint32_t camera = 0;       ///< IPv4 address that packets come from
    std::size_t packet_bytes = 0;   ///< with the headers of IP, UDP and GVSP
    std::size_t payload_bytes = 0;  ///< of a block, at most
    bool extended_ids = false;      ///< 64-bit block ids, 32-bit packet ids
};

/// The socket of this process that is bound to `local`; -1 if there is none.
[[nodiscard]] int udp_socket_at(UdpEndpoint local);

/// From here on the kernel drops datagrams to `socket` that are not leader, payload or trailer of
/// such a stream: from elsewhere, too short, of several parts, with other ids, or with the id of a
/// packet behind the last one of a block. Aravis (0.8.26) takes memory for any id. Datagrams that
/// have come before are dropped. Returns whether the kernel has taken the filter.
bool filter_gvsp(int socket, const GvspAgreement& agreed);

}  // namespace stipple
