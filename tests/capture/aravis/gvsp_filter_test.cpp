#include "capture/aravis/gige_link.h"

#include <gtest/gtest.h>
#include <poll.h>

#include "capture/serve/big_endian.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kLoopback = 0x7F000001;
/// Pieces of 576 - 36 bytes: packets 0 to 7 of a block.
constexpr GvspAgreement kAgreed{kLoopback, 576, 64 * 48, false};

Bytes packet(std::uint8_t format, std::uint32_t id, std::size_t bytes = 44) {
    Bytes packet(4, 0);
    append_be(packet, static_cast<std::uint32_t>(format) << 24U | id);
    packet.resize(bytes);
    return packet;
}

Bytes leader(std::uint16_t payload_type) {
    Bytes bytes = packet(1, 0);
    store_be(&bytes[10], payload_type);
    return bytes;
}

/// With 64-bit block ids.
Bytes extended(std::uint8_t format, std::uint32_t id) {
    Bytes bytes = packet(format | 0x80, 0, 56);
    store_be(&bytes[16], id);
    return bytes;
}

/// Whether a datagram that is sent comes through.
class FilteredSocket {
  public:
    explicit FilteredSocket(const GvspAgreement& agreed = kAgreed) {
        EXPECT_TRUE(filter_gvsp(socket_.descriptor(), agreed));
    }
    bool takes(const Bytes& bytes, std::uint32_t from = kLoopback) {
        const UdpSocket sender({from, 0});
        sender.send(socket_.local(), bytes);
        pollfd readable{socket_.descriptor(), POLLIN, 0};
        return poll(&readable, 1, 50) > 0 && socket_.receive().has_value();
    }

  private:
    UdpSocket socket_{{kLoopback, 0}};
};

TEST(GvspFilterTest, PacketsOfABlockComeThrough) {
    FilteredSocket socket;
    EXPECT_TRUE(socket.takes(leader(1)));
    EXPECT_TRUE(socket.takes(leader(0x4001)));
    EXPECT_TRUE(socket.takes(packet(3, 1, 9)));
    EXPECT_TRUE(socket.takes(packet(3, 6)));
    EXPECT_TRUE(socket.takes(packet(2, 7)));
}

TEST(GvspFilterTest, WhatWasNotAgreedOnIsDropped) {
    FilteredSocket socket;
    EXPECT_FALSE(socket.takes(packet(2, 8)));
    EXPECT_FALSE(socket.takes(packet(2, 0xFFFFFE)));
    EXPECT_FALSE(socket.takes(packet(3, 1, 8)));
    EXPECT_FALSE(socket.takes({}));
    EXPECT_FALSE(socket.takes({1, 2, 3}));
    EXPECT_FALSE(socket.takes(leader(0x0A)));
    EXPECT_FALSE(socket.takes(leader(0x400A)));
    EXPECT_FALSE(socket.takes(packet(4, 0)));
    EXPECT_FALSE(socket.takes(extended(3, 1)));
    EXPECT_FALSE(socket.takes(extended(2, 0xFFFFFFFE)));
    EXPECT_FALSE(socket.takes(packet(3, 1), kLoopback + 1));
    EXPECT_TRUE(socket.takes(packet(3, 1)));
}

TEST(GvspFilterTest, ExtendedIdsComeThroughIfTheyAreAgreedOn) {
    GvspAgreement agreed = kAgreed;
    agreed.extended_ids = true;  // pieces of 576 - 48 bytes: packets 0 to 7
    FilteredSocket socket(agreed);
    EXPECT_TRUE(socket.takes(extended(1, 0)));
    EXPECT_TRUE(socket.takes(extended(2, 7)));
    EXPECT_FALSE(socket.takes(extended(2, 8)));
    EXPECT_FALSE(socket.takes(packet(3, 1)));
}

TEST(GvspFilterTest, WhatCameBeforeIsDropped) {
    const UdpSocket socket({kLoopback, 0});
    const UdpSocket sender({kLoopback, 0});
    for (int i = 0; i < 5; ++i) sender.send(socket.local(), packet(2, 0xFFFFFE));
    EXPECT_TRUE(filter_gvsp(socket.descriptor(), kAgreed));
    EXPECT_FALSE(socket.receive());
}

TEST(GvspFilterTest, ASocketIsFoundByItsAddress) {
    const UdpSocket socket({kLoopback, 0});
    EXPECT_EQ(udp_socket_at(socket.local()), socket.descriptor());
    EXPECT_EQ(udp_socket_at({kLoopback + 1, socket.local().port}), -1);
    EXPECT_FALSE(filter_gvsp(-1, kAgreed));
}

}  // namespace
}  // namespace stipple
