#include "capture/serve/gvcp_codec.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

GvcpStatus refusal(const Bytes& datagram) {
    const auto command = decode_gvcp(datagram);
    if (!command || !std::holds_alternative<GvcpRefused>(command->body))
        return GvcpStatus::kSuccess;
    return std::get<GvcpRefused>(command->body).status;
}

// The datagrams are those of the GigE Vision standard, byte by byte.

TEST(GvcpCodecTest, ReadsADiscovery) {
    const auto command = decode_gvcp(Bytes{0x42, 0x11, 0, 2, 0, 0, 0x12, 0x34});
    ASSERT_TRUE(command);
    EXPECT_EQ(command->id, 0x1234);
    EXPECT_TRUE(command->wants_reply);
    EXPECT_TRUE(std::holds_alternative<GvcpDiscovery>(command->body));
}

TEST(GvcpCodecTest, ReadsSeveralRegistersInOneCommand) {
    const auto command =
        decode_gvcp(Bytes{0x42, 1, 0, 0x80, 0, 8, 0, 1, 0, 0, 0x0A, 0, 0, 0, 0x0D, 4});
    ASSERT_TRUE(command);
    EXPECT_EQ(std::get<GvcpReadRegisters>(command->body).addresses,
              (std::vector<std::uint32_t>{0xA00, 0xD04}));
}

TEST(GvcpCodecTest, ReadsAWriteOfARegister) {
    const auto command =
        decode_gvcp(Bytes{0x42, 1, 0, 0x82, 0, 8, 0, 1, 0, 0, 0x0A, 0, 0, 0, 0, 2});
    ASSERT_TRUE(command);
    const auto& writes = std::get<GvcpWriteRegisters>(command->body).writes;
    ASSERT_EQ(writes.size(), 1U);
    EXPECT_EQ(writes[0], (std::pair<std::uint32_t, std::uint32_t>{0xA00, 2}));
}

TEST(GvcpCodecTest, ReadsMemoryCommands) {
    const auto read =
        decode_gvcp(Bytes{0x42, 1, 0, 0x84, 0, 8, 0, 1, 0, 0x20, 0, 0, 0, 0, 2, 0x18});
    ASSERT_TRUE(read);
    EXPECT_EQ(std::get<GvcpReadMemory>(read->body).address, 0x200000U);
    EXPECT_EQ(std::get<GvcpReadMemory>(read->body).bytes, 536U);
    const auto write =
        decode_gvcp(Bytes{0x42, 1, 0, 0x86, 0, 8, 0, 1, 0, 0, 0, 0xE8, 'c', 'a', 'm', 0});
    ASSERT_TRUE(write);
    EXPECT_EQ(std::get<GvcpWriteMemory>(write->body).data, (Bytes{'c', 'a', 'm', 0}));
}

TEST(GvcpCodecTest, ReadsARequestForPackets) {
    const auto command =
        decode_gvcp(Bytes{0x42, 0, 0, 0x40, 0, 12, 0, 1, 0, 0, 0xFF, 0xFF, 0, 0, 0, 2, 0, 0, 1, 0});
    ASSERT_TRUE(command);
    EXPECT_FALSE(command->wants_reply);
    const auto& resend = std::get<GvcpPacketResend>(command->body);
    EXPECT_EQ(resend.block, 65535);
    EXPECT_EQ(resend.first, 2U);
    EXPECT_EQ(resend.last, 256U);
}

TEST(GvcpCodecTest, IgnoresWhatIsNoCommand) {
    EXPECT_FALSE(decode_gvcp(Bytes{}));
    EXPECT_FALSE(decode_gvcp(Bytes{0x42, 1, 0, 2, 0, 0, 0}));     // cut off
    EXPECT_FALSE(decode_gvcp(Bytes{0x41, 1, 0, 2, 0, 0, 0, 1}));  // other key
    EXPECT_FALSE(
        decode_gvcp(Bytes{0x42, 1, 0, 0x80, 0, 8, 0, 1, 0, 0, 0, 0}));  // shorter than told
    EXPECT_FALSE(decode_gvcp(Bytes(549, 0x42)));                        // longer than any command
}

TEST(GvcpCodecTest, SaysWhatIsWrongWithACommand) {
    EXPECT_EQ(refusal(Bytes{0x42, 1, 0x12, 0x34, 0, 0, 0, 1}), GvcpStatus::kNotImplemented);
    // No address, half an address, a value without address.
    EXPECT_EQ(refusal(Bytes{0x42, 1, 0, 0x80, 0, 0, 0, 1}), GvcpStatus::kInvalidParameter);
    EXPECT_EQ(refusal(Bytes{0x42, 1, 0, 0x80, 0, 2, 0, 1, 0, 0}), GvcpStatus::kInvalidParameter);
    EXPECT_EQ(refusal(Bytes{0x42, 1, 0, 0x82, 0, 4, 0, 1, 0, 0, 0, 0}),
              GvcpStatus::kInvalidParameter);
    // 0, 2 and 540 bytes of memory.
    Bytes read{0x42, 1, 0, 0x84, 0, 8, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(refusal(read), GvcpStatus::kInvalidParameter);
    read[15] = 2;
    EXPECT_EQ(refusal(read), GvcpStatus::kBadAlignment);
    read[14] = 0x02;
    read[15] = 0x1C;
    EXPECT_EQ(refusal(read), GvcpStatus::kInvalidParameter);
    // Block ids of 64 bits.
    EXPECT_EQ(refusal(Bytes{0x42, 0x10, 0, 0x40, 0, 12, 0, 1, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 1, 0}),
              GvcpStatus::kNotImplemented);
}

TEST(GvcpCodecTest, RepliesCarryStatusAndIdOfTheCommand) {
    GvcpCommand command;
    command.code = 0x80;
    command.id = 0x0102;
    EXPECT_EQ(encode_gvcp_reply(command, GvcpStatus::kAccessDenied, Bytes{9, 8}),
              (Bytes{0x80, 0x06, 0, 0x81, 0, 2, 1, 2, 9, 8}));
}

}  // namespace
}  // namespace stipple
