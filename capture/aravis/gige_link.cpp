#include "capture/aravis/gige_link.h"

#include <arv.h>
#include <fmt/format.h>

#include <algorithm>

#include "capture/doctor/network_facts.h"

namespace stipple {
namespace {

constexpr int kLoopbackPacketBytes = 9000;

}  // namespace

GigeLink::GigeLink(AravisDevice& device, std::optional<int> packet_bytes)
    : interface_(interface_towards(device.address().substr(5))) {
    auto* camera = static_cast<ArvCamera*>(device.native());
    const auto before = arv_camera_gv_get_packet_size(camera, nullptr);
    // A camera that answers no test packets keeps its size; on loopback no switch is in between.
    if (!packet_bytes && arv_camera_gv_auto_packet_size(camera, nullptr) <= before && interface_ &&
        interface_->is_loopback)
        packet_bytes = kLoopbackPacketBytes;
    if (packet_bytes) {
        arv_camera_gv_set_packet_size_adjustment(camera, ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
        arv_camera_gv_set_packet_size(camera, *packet_bytes, nullptr);
    }
    const auto size = arv_camera_gv_get_packet_size(camera, nullptr);
    facts_["packet_bytes"] = fmt::format("{}", size);
    if (interface_) watch_interface(size);
}

void GigeLink::watch_interface(std::uint32_t packet_bytes) {
    facts_["interface"] = interface_->name;
    link_faults_before_ = link_faults(interface_->name);
    if (interface_->mtu == 0) return;
    facts_["mtu"] = fmt::format("{}", interface_->mtu);
    if (static_cast<int>(packet_bytes) > interface_->mtu)
        warnings_.push_back(
            fmt::format("packets of {} bytes exceed the MTU {} of {}: set "
                        "GevSCPSPacketSize to at most that, or raise the MTU",
                        packet_bytes, interface_->mtu, interface_->name));
}

void GigeLink::set_socket_buffer(void* stream, std::size_t frame_bytes, int frames) {
    const std::int64_t wanted = static_cast<std::int64_t>(frame_bytes) * frames;
    const std::int64_t max_bytes = rmem_max_bytes();
    packet_socket_ = can_open_packet_socket();
    const std::int64_t given = std::clamp<std::int64_t>(
        max_bytes > 0 ? std::min(wanted, max_bytes) : wanted, 65536, 1 << 30);
    g_object_set(stream, "packet-resend", ARV_GV_STREAM_PACKET_RESEND_ALWAYS, "socket-buffer",
                 ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size", static_cast<gint>(given),
                 nullptr);
    facts_["packet_resend"] = "always";
    facts_["socket"] = packet_socket_ ? "packet" : "udp";
    facts_["socket_buffer_wanted_bytes"] = fmt::format("{}", wanted);
    facts_["socket_buffer_bytes"] = fmt::format("{}", given);
    facts_["rmem_max_bytes"] = fmt::format("{}", max_bytes);
    if (!packet_socket_ && wanted > max_bytes)
        warnings_.push_back(fmt::format(
            "the receive buffer holds {:.1f} frames of {} wanted, packets may be lost: \"sysctl -w "
            "net.core.rmem_max={}\" (now {}) or give CAP_NET_RAW",
            static_cast<double>(given) / static_cast<double>(frame_bytes), frames, wanted,
            max_bytes));
}

void GigeLink::count(void* stream, TransportCounts& counts) const {
    if (!packet_socket_)
        counts.socket_drops = udp_drops(arv_gv_stream_get_port(ARV_GV_STREAM(stream)));
    if (interface_) counts.link_faults = link_faults(interface_->name) - link_faults_before_;
}

}  // namespace stipple
