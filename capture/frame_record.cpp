#include "capture/frame_record.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace stipple {

std::size_t FrameLayout::payload_bytes() const {
    if (format == nullptr || height <= 0) return 0;
    return stride_bytes * (static_cast<std::size_t>(height) - 1) + format->row_bytes(width);
}

std::uint64_t payload_hash(std::span<const std::uint8_t> payload) {
    return XXH3_64bits(payload.data(), payload.size());
}

}  // namespace stipple
