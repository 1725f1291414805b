#include "capture/aravis/aravis_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "capture/frame_payload.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Holes = std::vector<std::pair<std::size_t, std::size_t>>;

constexpr std::uint64_t kFrame = 0x1234;

Bytes packet(char kind, std::uint64_t id, std::uint8_t size) {
    Bytes bytes{'U', '3', 'V', static_cast<std::uint8_t>(kind), 0, 0, size, 0};
    for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<std::uint8_t>(id >> (8 * i)));
    bytes.resize(size);
    return bytes;
}

/// The holes of a frame of 1000 bytes of which `left` came, then `next`.
Holes holes_of(std::size_t left, const Bytes& next) {
    Bytes buffer(1000);
    mark_unwritten(buffer);
    std::fill_n(buffer.begin(), left, std::uint8_t{7});
    const std::size_t kept = std::min(next.size(), buffer.size() - left);
    std::copy_n(next.begin(), kept, buffer.begin() + static_cast<std::ptrdiff_t>(left));
    erase_usb_packets(buffer, kFrame);
    return clear_holes(buffer);
}

TEST(UsbPacketsTest, TheTrailerOfAFrameThatWasCutIsNoImage) {
    for (const std::size_t left : {0U, 5U, 501U, 968U})
        EXPECT_EQ(holes_of(left, packet('T', kFrame, 28)), (Holes{{left, 1000}})) << left;
}

TEST(UsbPacketsTest, TheLeaderOfALaterFrameIsNoImage) {
    EXPECT_EQ(holes_of(333, packet('L', kFrame + 1, 52)), (Holes{{333, 1000}}));
    EXPECT_EQ(holes_of(960, packet('L', kFrame + 1, 52)), (Holes{{960, 1000}}));
}

TEST(UsbPacketsTest, PixelsThatOnlyBeginLikeAPacketStay) {
    for (const Bytes& pixels :
         {packet('T', kFrame + 1, 28), packet('L', kFrame, 52), packet('X', kFrame, 28),
          packet('T', kFrame, 15), Bytes{'U', '3', 'V', 'T'}})
        EXPECT_EQ(holes_of(333, pixels), (Holes{{333 + pixels.size(), 1000}}));
}

}  // namespace
}  // namespace stipple
