#include "capture/frame_record.h"

namespace stipple {

std::size_t FrameLayout::payload_bytes() const {
    if (format == nullptr || height <= 0) return 0;
    return stride_bytes * (static_cast<std::size_t>(height) - 1) + format->row_bytes(width);
}

}  // namespace stipple
