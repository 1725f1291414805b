#include "view/packet_source.h"

#include <algorithm>
#include <utility>

namespace stipple {

FilePackets::FilePackets(StreamReader reader) : reader_(std::move(reader)) {
    reader_.follow_switches();
    header_ = std::make_shared<StreamHeader>(reader_.header());
    if (const auto known = reader_.slots()) {
        extent_ = {*known, true};
        reader_.seek(*known);
        take_switches();
    }
}

void FilePackets::take_switches() {
    if (reader_.header().switches.size() > header_->switches.size())
        header_ = std::make_shared<StreamHeader>(reader_.header());
}

SlotExtent FilePackets::extent() {
    if (extent_.complete) return extent_;
    next_slot_ = -1;
    reader_.seek(std::max<std::int64_t>(extent_.slots - 1, 0));
    for (SamplePacket packet; reader_.next(packet);)
        extent_.slots = std::max(extent_.slots, packet.slot + 1);
    extent_.complete = reader_.report().complete;
    take_switches();
    return extent_;
}

std::shared_ptr<const StreamHeader> FilePackets::visit(
    std::int64_t first, std::int64_t end, const std::function<void(const SamplePacket&)>& take) {
    if (first != next_slot_) reader_.seek(first);
    next_slot_ = -1;
    for (SamplePacket packet; next_slot_ != end && reader_.next(packet) && packet.slot < end;) {
        if (packet.slot >= first) take(packet);
        const bool last = packet.first_row + packet.rows == reader_.header().shape.rows;
        next_slot_ = last ? packet.slot + 1 : -1;
    }
    if (next_slot_ != end) next_slot_ = -1;
    take_switches();
    return header_;
}

}  // namespace stipple
