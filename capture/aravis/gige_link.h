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

namespace stipple {

/// The network under the stream of a GigE Vision camera: size of its packets, socket, and what is
/// lost there.
class GigeLink {
  public:
    /// Before the stream is made. Packets, headers included, have `packet_bytes`, or as many as the
    /// path carries. `device` must outlive the link.
    GigeLink(AravisDevice& device, std::optional<int> packet_bytes);

    /// `stream` is the ArvStream. Its socket is to hold `frames` of `frame_bytes`.
    void set_socket_buffer(void* stream, std::size_t frame_bytes, int frames);
    /// Adds what socket and interface have lost since.
    void count(void* stream, TransportCounts& counts) const;

    /// For CameraDescription.
    [[nodiscard]] const std::map<std::string, std::string>& facts() const { return facts_; }
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    void watch_interface(std::uint32_t packet_bytes);

    std::optional<NetworkInterface> interface_;
    std::uint64_t link_faults_before_ = 0;
    bool packet_socket_ = false;
    std::map<std::string, std::string> facts_;
    std::vector<std::string> warnings_;
};

}  // namespace stipple
