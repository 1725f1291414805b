#include "capture/serve/gvsp_sender.h"

#include <algorithm>
#include <array>
#include <utility>

namespace stipple {
namespace {

/// Packets that are handed to the system together.
constexpr std::size_t kBatch = 32;

DatagramParts parts_of(const GvspPacket& packet) {
    return {std::span(packet.head).first(packet.head_bytes), packet.data};
}

}  // namespace

bool GvspSender::send(const std::shared_ptr<const NumberedBlock>& block, UdpEndpoint to,
                      const PacketPace& pace) {
    keep(block);
    const auto order = packets_to_send(faults_, block->number, block->block.packets());
    const std::size_t batch = pace.delay.count() > 0 ? 1 : kBatch;
    std::array<GvspPacket, kBatch> packets;
    std::array<DatagramParts, kBatch> parts;
    auto due = std::chrono::steady_clock::now();
    for (std::size_t at = 0; at < order.size(); at += batch) {
        const std::size_t count = std::min(batch, order.size() - at);
        for (std::size_t i = 0; i < count; ++i) {
            packets[i] = gvsp_packet(block->block, order[at + i]);
            parts[i] = parts_of(packets[i]);
        }
        if (pace.delay.count() > 0 && !pace.wait_until(due += pace.delay)) return false;
        sent_ += socket_.send(to, std::span(parts).first(count));
    }
    return true;
}

void GvspSender::resend(const GvcpPacketResend& wanted, UdpEndpoint to) {
    const auto block = find(wanted.block);
    if (!block) {
        const GvspPacket gone = gvsp_unavailable(wanted.block, wanted.first);
        const DatagramParts parts = parts_of(gone);
        socket_.send(to, std::span(&parts, 1));
        return;
    }
    const std::uint32_t end =
        std::min({block->block.packets(), wanted.last + 1, wanted.first + kMaxResent});
    for (std::uint32_t index = wanted.first; index < end; ++index) {
        if (is_lost(faults_, block->number, index)) continue;
        const GvspPacket packet = gvsp_packet(block->block, index, GvspStatus::kResent);
        const DatagramParts parts = parts_of(packet);
        resent_ += socket_.send(to, std::span(&parts, 1));
    }
}

void GvspSender::forget() {
    const std::scoped_lock lock(mutex_);
    history_.clear();
    history_bytes_ = 0;
}

void GvspSender::keep(std::shared_ptr<const NumberedBlock> block) {
    const std::scoped_lock lock(mutex_);
    history_bytes_ += block->block.payload.size();
    history_.push_back(std::move(block));
    while (history_.size() > 1 && history_bytes_ > kHistoryBytes) {
        history_bytes_ -= history_.front()->block.payload.size();
        history_.pop_front();
    }
}

std::shared_ptr<const NumberedBlock> GvspSender::find(std::uint16_t id) {
    const std::scoped_lock lock(mutex_);
    const auto found = std::find_if(history_.rbegin(), history_.rend(),
                                    [&](const auto& kept) { return kept->block.id == id; });
    return found == history_.rend() ? nullptr : *found;
}

}  // namespace stipple
