#pragma once

#include <cstdint>
#include <span>

namespace stipple {

/// If a USB3 Vision camera sends less than announced, the next leader or trailer is read into the
/// rest of the image. This function finds such packets in `buffer`, the memory of the incomplete
/// frame `frame_id`, and overwrites them with the pattern of `mark_unwritten`: the frame's own
/// trailer, or the leader of a later frame (USB3 Vision 1.0.1, 5.4: magic, size and id of the
/// frame).
void erase_usb_packets(std::span<std::uint8_t> buffer, std::uint64_t frame_id) noexcept;

}  // namespace stipple
