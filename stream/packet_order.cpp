#include "stream/packet_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace stipple {

void PacketOrder::skip_to(StreamPosition next) {
    assert(next >= expected_);
    if (next == expected_) return;
    const std::int64_t begin = std::max(expected_.slot, counted_);
    const std::int64_t end = next.row > 0 ? next.slot + 1 : next.slot;
    missing_slots_ += std::max<std::int64_t>(end - begin, 0);
    counted_ = std::max(counted_, end);
    expected_ = next;
}

void PacketOrder::advance(int rows) {
    expected_.row += rows;
    assert(expected_.row <= array_rows_);
    if (expected_.row == array_rows_) expected_ = {expected_.slot + 1, 0};
}

std::string PacketOrder::missing_before(StreamPosition next) const {
    const StreamPosition last = next.row > 0 ? StreamPosition{next.slot, next.row - 1}
                                             : StreamPosition{next.slot - 1, array_rows_ - 1};
    if (expected_.row == 0 && next.row == 0)
        return last.slot == expected_.slot
                   ? fmt::format("slot {} is missing", last.slot)
                   : fmt::format("slots {}..{} are missing", expected_.slot, last.slot);
    if (expected_.slot == last.slot)
        return fmt::format("rows {}..{} of slot {} are missing", expected_.row, last.row,
                           last.slot);
    return fmt::format("slot {} from row {} to slot {} row {} is missing", expected_.slot,
                       expected_.row, last.slot, last.row);
}

}  // namespace stipple
