#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

#include "capture/serve/gvcp_codec.h"
#include "capture/serve/gvsp_codec.h"
#include "capture/serve/gvsp_faults.h"
#include "capture/serve/udp_socket.h"

namespace stipple {

/// A block with the number of its frame, by which faults are chosen.
struct NumberedBlock {
    std::uint64_t number = 0;
    GvspBlock block;
};

/// The time between two packets.
struct PacketPace {
    std::chrono::nanoseconds delay{0};
    /// Waits until then; false: the rest of the block is not wanted any more.
    std::function<bool(std::chrono::steady_clock::time_point)> wait_until;
};

/// Sends blocks as packets and keeps the last ones, in case some are asked for again. `send` and
/// `resend` may be called from different threads.
class GvspSender {
  public:
    /// Blocks that can be sent again: as many as fit into kHistoryBytes, at least one.
    static constexpr std::size_t kHistoryBytes = std::size_t{64} << 20U;

    /// Of one request, so that 20 bytes do not make us flood the network; clients ask again.
    static constexpr std::uint32_t kMaxResent = 512;

    GvspSender(const UdpSocket& socket, const GvspFaults& faults)
        : socket_(socket), faults_(faults) {}

    /// Sends packet by packet. Returns whether all packets were: not if the wait was ended.
    bool send(const std::shared_ptr<const NumberedBlock>& block, UdpEndpoint to,
              const PacketPace& pace);
    /// Sends packets of the block again, up to kMaxResent of those that are asked for.
    void resend(const GvcpPacketResend& wanted, UdpEndpoint to);
    void forget();

    [[nodiscard]] std::uint64_t packets_sent() const { return sent_; }
    [[nodiscard]] std::uint64_t packets_resent() const { return resent_; }

  private:
    void keep(std::shared_ptr<const NumberedBlock> block);
    [[nodiscard]] std::shared_ptr<const NumberedBlock> find(std::uint16_t id);

    const UdpSocket& socket_;
    GvspFaults faults_;
    std::mutex mutex_;  ///< of the history
    std::deque<std::shared_ptr<const NumberedBlock>> history_;
    std::size_t history_bytes_ = 0;
    std::atomic<std::uint64_t> sent_{0};
    std::atomic<std::uint64_t> resent_{0};
};

}  // namespace stipple
