#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

#include "capture/serve/frame_source.h"
#include "capture/serve/gige_device.h"
#include "capture/serve/gvcp_codec.h"
#include "capture/serve/gvsp_codec.h"
#include "capture/serve/gvsp_faults.h"
#include "capture/serve/udp_socket.h"

namespace stipple {

/// A frame ready for sending: its region, followed by the enabled chunks. The caller sets the id.
/// Precondition: frame.payload is a whole image in settings.format.
[[nodiscard]] GvspBlock served_block(ServedFrame frame, const ServedImage& image,
                                     const GigeStreamSettings& settings,
                                     std::uint64_t timestamp_ns);

/// A block and the number of its frame, which selects the faults.
struct NumberedBlock {
    std::uint64_t number = 0;
    GvspBlock block;
};

/// The time between two packets.
struct PacketPace {
    std::chrono::nanoseconds delay{0};
    /// Waits until that time. False: stop sending the block.
    std::function<bool(std::chrono::steady_clock::time_point)> wait_until;
};

/// Sends blocks as packets and keeps the last ones for resend requests. `send` and `resend` may be
/// called from different threads.
class GvspSender {
  public:
    /// Size of the resend history; it holds at least one block.
    static constexpr std::size_t kHistoryBytes = std::size_t{64} << 20U;

    /// Maximum number of packets per request, so that a request of 20 bytes cannot flood the
    /// network.
    static constexpr std::uint32_t kMaxResent = 512;

    GvspSender(const UdpSocket& socket, const GvspFaults& faults)
        : socket_(socket), faults_(faults) {}

    /// Sends packet by packet. Returns whether all packets were sent: false if `pace` stopped it.
    bool send(const std::shared_ptr<const NumberedBlock>& block, UdpEndpoint to,
              const PacketPace& pace);
    /// Sends the requested packets again, up to kMaxResent.
    void resend(const GvcpPacketResend& wanted, UdpEndpoint to);
    void forget();

    [[nodiscard]] std::uint64_t packets_sent() const { return sent_; }
    [[nodiscard]] std::uint64_t packets_resent() const { return resent_; }

  private:
    void keep(std::shared_ptr<const NumberedBlock> block);
    [[nodiscard]] std::shared_ptr<const NumberedBlock> find(std::uint16_t id);

    const UdpSocket& socket_;
    GvspFaults faults_;
    std::mutex mutex_;  ///< guards the history
    std::deque<std::shared_ptr<const NumberedBlock>> history_;
    std::size_t history_bytes_ = 0;
    std::atomic<std::uint64_t> sent_{0};
    std::atomic<std::uint64_t> resent_{0};
};

}  // namespace stipple
