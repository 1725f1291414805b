#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/aravis/aravis_stream.h"
#include "capture/frame_payload.h"
#include "stream/little_endian.h"
#include "tests/fuzz/require.h"

namespace {

constexpr std::size_t kHeaderBytes = 16;
constexpr std::size_t kMaxPacketBytes = 1024;
constexpr std::array<std::uint8_t, 3> kMagic{'U', '3', 'V'};

bool has_magic(std::span<const std::uint8_t> bytes) {
    return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

/// The trailer of the frame, or the leader of a later one.
bool is_packet(std::span<const std::uint8_t> bytes, std::uint64_t frame) {
    if (bytes.size() < kHeaderBytes || !has_magic(bytes)) return false;
    const int size = bytes[6] + 256 * bytes[7];
    const auto id = stipple::load<std::uint64_t>(&bytes[8]);
    return size >= 16 && size <= 1024 &&
           (bytes[3] == 'T' ? id == frame : bytes[3] == 'L' && id > frame);
}

}  // namespace

/// Input: 8 bytes, the id of the frame, then its memory. Only what follows the magic of a packet is
/// erased, as far as a packet may reach, and no packet is left.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    if (size < 8) return 0;
    const auto id = load<std::uint64_t>(data);
    const std::span<const std::uint8_t> before(data + 8, size - 8);
    std::vector<std::uint8_t> after(before.begin(), before.end());
    erase_usb_packets(after, id);

    std::vector<std::uint8_t> pattern(after.size());
    mark_unwritten(pattern);
    std::size_t reach = 0;  // end of the longest packet that may have begun
    for (std::size_t i = 0; i < after.size(); ++i) {
        const auto was = before.subspan(i);
        if (has_magic(was)) reach = i + kMaxPacketBytes;
        require(after[i] == before[i] || (after[i] == pattern[i] && i < reach));
        require(!is_packet(was, id) || has_magic(std::span(after).subspan(i)) == false);
    }
    return 0;
}
