#include "stream/crc32c.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes rising(std::size_t count) {
    Bytes bytes(count);
    std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
    return bytes;
}

void expect_crc(const Bytes& bytes, std::uint32_t expected) {
    EXPECT_EQ(crc32c(bytes), expected);
    EXPECT_EQ(crc32c_portable(bytes), expected);
}

// RFC 3720, B.4; the CRCs there are listed byte by byte in the order of transmission.
TEST(Crc32cTest, AgreesWithTheExamplesOfRfc3720) {
    expect_crc(Bytes(32, 0x00), 0x8A9136AA);
    expect_crc(Bytes(32, 0xFF), 0x62A8AB43);
    expect_crc(rising(32), 0x46DD794E);
    const Bytes up = rising(32);
    expect_crc(Bytes(up.rbegin(), up.rend()), 0x113FDB5C);
    Bytes read_command(48);
    read_command[0] = 0x01;
    read_command[1] = 0xC0;
    read_command[16] = 0x14;
    read_command[22] = 0x04;
    read_command[27] = 0x14;
    read_command[31] = 0x18;
    read_command[32] = 0x28;
    read_command[40] = 0x02;
    expect_crc(read_command, 0xD9963A56);
}

TEST(Crc32cTest, TheInstructionAndTheTablesAgreeAtEachLengthAndAlignment) {
    const Bytes bytes = rising(100);
    for (std::size_t begin = 0; begin < 9; ++begin)
        for (std::size_t length = 0; begin + length <= bytes.size(); ++length) {
            const auto part = std::span(bytes).subspan(begin, length);
            EXPECT_EQ(crc32c(part), crc32c_portable(part)) << begin << " " << length;
        }
}

TEST(Crc32cTest, ContinuesWhereItStopped) {
    const Bytes bytes = rising(50);
    for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
        const auto [first, rest] =
            std::pair(std::span(bytes).first(cut), std::span(bytes).subspan(cut));
        EXPECT_EQ(crc32c(rest, crc32c(first)), crc32c(bytes));
        EXPECT_EQ(crc32c_portable(rest, crc32c_portable(first)), crc32c(bytes));
    }
}

}  // namespace
}  // namespace stipple
