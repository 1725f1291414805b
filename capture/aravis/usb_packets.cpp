#include "capture/aravis/aravis_stream.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "capture/frame_payload.h"
#include "stream/little_endian.h"

namespace stipple {
namespace {

constexpr std::array<std::uint8_t, 3> kMagic{'U', '3', 'V'};  // then L or T
constexpr std::size_t kHeaderBytes = 16;
constexpr std::size_t kMaxPacketBytes = 1024;

/// The size of the packet that begins with `bytes`; 0 if none does.
std::size_t packet_bytes(std::span<const std::uint8_t> bytes, std::uint64_t frame_id) {
    if (bytes.size() < kHeaderBytes) return 0;
    const std::uint64_t id = load<std::uint64_t>(&bytes[8]);
    const bool is_ours = bytes[3] == 'T' && id == frame_id;
    const bool is_later = bytes[3] == 'L' && id > frame_id;
    const std::size_t size = load<std::uint16_t>(&bytes[6]);
    return (is_ours || is_later) && size >= kHeaderBytes && size <= kMaxPacketBytes ? size : 0;
}

}  // namespace

void erase_usb_packets(std::span<std::uint8_t> buffer, std::uint64_t frame_id) noexcept {
    auto at = buffer.begin();
    for (;;) {
        at = std::search(at, buffer.end(), kMagic.begin(), kMagic.end());
        if (at == buffer.end()) return;
        const auto begin = static_cast<std::size_t>(at - buffer.begin());
        if (const std::size_t size = packet_bytes(buffer.subspan(begin), frame_id); size > 0)
            mark_unwritten(buffer, begin, std::min(begin + size, buffer.size()));
        ++at;
    }
}

}  // namespace stipple
