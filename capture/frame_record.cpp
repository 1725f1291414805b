#include "capture/frame_record.h"

#include <algorithm>

namespace stipple {

std::size_t FrameLayout::payload_bytes() const {
    if (format == nullptr || height <= 0) return 0;
    return stride_bytes * (static_cast<std::size_t>(height) - 1) + format->row_bytes(width);
}

std::uint64_t missing_after(std::uint64_t id_before, const FrameRecord& record) {
    const std::uint64_t by_ids = record.id > id_before ? record.id - id_before - 1 : 0;
    return std::max(record.lost_before, by_ids);
}

}  // namespace stipple
