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

/// The network of the stream of a GigE Vision camera: packet size, socket, losses.
class GigeLink {
  public:
    /// To be made before the stream. `packet_bytes` is the packet size with headers; default: the
    /// largest that the path carries. `device` must outlive the link.
    GigeLink(AravisDevice& device, std::optional<int> packet_bytes);

    /// Asks for a socket buffer of `frames` frames of `frame_bytes`. `stream` is the ArvStream.
    void set_socket_buffer(void* stream, std::size_t frame_bytes, int frames);
    /// Fills in the losses of socket and interface since the construction.
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
