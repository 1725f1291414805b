#include "capture/aravis/gige_link.h"

#include <arv.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>

#include "capture/aravis/aravis_call.h"
#include "capture/network.h"
#include "capture/serve/big_endian.h"

namespace stipple {
namespace {

constexpr int kLoopbackPacketBytes = 9000;

ArvCamera* native(const AravisDevice& device) {
    return static_cast<ArvCamera*>(device.native());
}

/// In host byte order.
std::uint32_t address_of(GSocketAddress* address) {
    GInetAddress* const ip = g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(address));
    return load_be<std::uint32_t>(g_inet_address_to_bytes(ip));
}

/// Returns the bytes given: root may have more than net.core.rmem_max.
std::int64_t set_receive_buffer(int socket, std::int64_t wanted) {
    const int bytes = static_cast<int>(std::clamp<std::int64_t>(wanted, 65536, 1 << 30));
    if (setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) != 0)
        setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
    int given = 0;
    socklen_t size = sizeof given;
    getsockopt(socket, SOL_SOCKET, SO_RCVBUF, &given, &size);
    return given / 2;  // the kernel has doubled it for its own needs
}

}  // namespace

GigeLink::GigeLink(AravisDevice& device, std::optional<int> packet_bytes)
    : interface_(interface_towards(device.address().substr(5))),
      device_(device),
      extended_ids_(device.read("GevGVSPExtendedIDMode") == "On") {
    ArvCamera* const camera = native(device);
    // The filter takes the place of what its packet sockets offer.
    arv_camera_gv_set_stream_options(camera, ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
    GlibError error;
    const auto before = arv_camera_gv_get_packet_size(camera, error.slot());
    error.check_answer(device.address());
    if (!packet_bytes) {
        const auto probed = arv_camera_gv_auto_packet_size(camera, error.slot());
        error.check_answer(device.address());
        // A camera that answers no test packets keeps its size; on loopback no switch is between.
        if (probed <= before && interface_ && interface_->is_loopback)
            packet_bytes = kLoopbackPacketBytes;
    }
    if (packet_bytes) {
        arv_camera_gv_set_packet_size_adjustment(camera, ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
        arv_camera_gv_set_packet_size(camera, *packet_bytes, error.slot());
        error.check_answer(device.address());
    }
    packet_bytes_ = arv_camera_gv_get_packet_size(camera, error.slot());
    error.check_answer(device.address());
    facts_["packet_bytes"] = fmt::format("{}", packet_bytes_);
    if (interface_) watch_interface(packet_bytes_);
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

void GigeLink::prepare_socket(std::size_t block_bytes, std::size_t frame_bytes, int frames) noexcept
    try {
    auto* const gige = ARV_GV_DEVICE(arv_camera_get_device(native(device_)));
    filtered_port_ = 0;
    const UdpEndpoint local{address_of(arv_gv_device_get_interface_address(gige)),
                            static_cast<std::uint16_t>(arv_device_get_integer_feature_value(
                                ARV_DEVICE(gige), "ArvGevSCPHostPort", nullptr))};
    const int socket = udp_socket_at(local);
    if (arv_camera_gv_get_packet_size(native(device_), nullptr) != packet_bytes_ ||
        !filter_gvsp(socket, {.camera = address_of(arv_gv_device_get_device_address(gige)),
                              .packet_bytes = packet_bytes_,
                              .payload_bytes = block_bytes,
                              .extended_ids = extended_ids_}))
        return;
    filtered_port_ = local.port;
    const std::int64_t wanted = static_cast<std::int64_t>(frame_bytes) * frames;
    judge_buffer(wanted, set_receive_buffer(socket, wanted), frame_bytes, frames);
} catch (...) {
    filtered_port_ = 0;
}

void GigeLink::check(void* stream) {
    if (filtered_port_ == 0 || filtered_port_ != arv_gv_stream_get_port(ARV_GV_STREAM(stream)))
        throw DeviceError(device_.address(),
                          "its stream cannot be filtered: it says that it sends to another port, "
                          "or in packets of another size, than it was told");
    g_object_set(stream, "packet-resend", ARV_GV_STREAM_PACKET_RESEND_ALWAYS, "socket-buffer",
                 ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size", -1, nullptr);
    facts_["packet_resend"] = "always";
}

void GigeLink::judge_buffer(std::int64_t wanted, std::int64_t given, std::size_t frame_bytes,
                            int frames) {
    facts_["socket_buffer_wanted_bytes"] = fmt::format("{}", wanted);
    facts_["socket_buffer_bytes"] = fmt::format("{}", given);
    facts_["rmem_max_bytes"] = fmt::format("{}", rmem_max_bytes());
    if (given < wanted)
        warnings_.push_back(fmt::format(
            "the receive buffer holds {:.1f} frames of {} wanted, packets may be lost: \"sysctl -w "
            "net.core.rmem_max={}\" (now {}) or give CAP_NET_ADMIN",
            static_cast<double>(given) / static_cast<double>(frame_bytes), frames, wanted,
            rmem_max_bytes()));
}

void GigeLink::count(void* stream, TransportCounts& counts) const {
    counts.socket_drops = udp_drops(arv_gv_stream_get_port(ARV_GV_STREAM(stream)));
    if (interface_) counts.link_faults = link_faults(interface_->name) - link_faults_before_;
}

}  // namespace stipple
