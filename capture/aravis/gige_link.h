#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capture/aravis/aravis_device.h"
#include "capture/camera.h"
#include "capture/network.h"
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

/// The network of the stream of a GigE Vision camera: packet size, socket, losses.
class GigeLink {
  public:
    /// To be made before the stream. `packet_bytes` is the packet size with headers; default: the
    /// largest that the path carries. `device` must outlive the link. \throws DeviceError.
    GigeLink(AravisDevice& device, std::optional<int> packet_bytes);

    /// Lets only packets in that fit to blocks of at most `block_bytes` (filter_gvsp), and asks for
    /// a socket buffer of `frames` frames of `frame_bytes`. To be called by the thread that
    /// receives, before it does: then nothing has been read.
    void prepare_socket(std::size_t block_bytes, std::size_t frame_bytes, int frames) noexcept;
    /// After that. `stream` is the ArvStream. \throws DeviceError if the socket has no filter.
    void check(void* stream);
    /// Fills in the losses of socket and interface since the construction.
    void count(void* stream, TransportCounts& counts) const;

    /// For CameraDescription.
    [[nodiscard]] const std::map<std::string, std::string>& facts() const { return facts_; }
    [[nodiscard]] const std::vector<Message>& warnings() const { return warnings_; }

  private:
    void watch_interface(std::uint32_t packet_bytes);
    void judge_buffer(std::int64_t wanted, std::int64_t given, std::size_t frame_bytes, int frames);

    std::optional<NetworkInterface> interface_;
    AravisDevice& device_;
    bool extended_ids_;
    std::uint32_t packet_bytes_ = 0;
    std::uint16_t filtered_port_ = 0;  ///< of the socket with the filter; 0: none
    std::uint64_t link_faults_before_ = 0;
    std::map<std::string, std::string> facts_;
    std::vector<Message> warnings_;
};

}  // namespace stipple
