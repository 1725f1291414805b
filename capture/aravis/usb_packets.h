#pragma once

#include <cstdint>
#include <span>

namespace stipple {

/// Where a USB3 Vision camera sends less than was asked for, the leader or trailer that comes next
/// is read into the rest of the image. Writes the pattern of `mark_unwritten` over any in `buffer`,
/// the memory of the incomplete frame `frame_id`: its own trailer, or the leader of a later frame
/// (USB3 Vision 1.0.1, 5.4: magic, size and id of the frame).
void erase_usb_packets(std::span<std::uint8_t> buffer, std::uint64_t frame_id) noexcept;

}  // namespace stipple
