#include "stream/bit_packing.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/philox.h"

namespace stipple {
namespace {

using Samples = std::vector<std::uint16_t>;
using Bytes = std::vector<std::uint8_t>;

/// The definition (docs/stream_format.md, kind 1), bit by bit.
Bytes pack_plainly(const Samples& dn, int bit_depth) {
    Bytes packed(packed_bytes(dn.size(), bit_depth));
    const auto depth = static_cast<std::size_t>(bit_depth);
    for (std::size_t k = 0; k < dn.size() * depth; ++k) {
        const unsigned bit = (dn[k / depth] >> (k % depth)) & 1U;
        packed[k / 8] = static_cast<std::uint8_t>(packed[k / 8] | bit << (k % 8));
    }
    return packed;
}

Samples random_samples(std::size_t count, int bit_depth) {
    Samples dn(count);
    for (std::uint32_t i = 0; i < count; ++i)
        dn[i] = static_cast<std::uint16_t>(philox4x32({i, 0, 0, 0}, 7)[0] >> (32 - bit_depth));
    return dn;
}

// 70 samples: several groups of eight, moved as words, and each possible rest.
TEST(BitPackingTest, PacksAsTheFormatSaysAtEachDepthAndCount) {
    for (int bit_depth = 1; bit_depth <= 16; ++bit_depth)
        for (std::size_t count = 0; count <= 70; ++count) {
            const Samples dn = random_samples(count, bit_depth);
            Bytes packed(packed_bytes(count, bit_depth), 0xFF);
            pack_bits(dn, bit_depth, packed);
            EXPECT_EQ(packed, pack_plainly(dn, bit_depth)) << bit_depth << " bits, " << count;
        }
}

TEST(BitPackingTest, UnpacksWhatWasPackedAtEachDepthAndCount) {
    for (int bit_depth = 1; bit_depth <= 16; ++bit_depth)
        for (std::size_t count = 0; count <= 70; ++count) {
            const Samples dn = random_samples(count, bit_depth);
            Samples unpacked(count, 0xFFFF);
            unpack_bits(pack_plainly(dn, bit_depth), bit_depth, unpacked);
            EXPECT_EQ(unpacked, dn) << bit_depth << " bits, " << count;
        }
}

TEST(BitPackingTest, KeepsTheExtremes) {
    for (int bit_depth = 1; bit_depth <= 16; ++bit_depth) {
        const auto most = static_cast<std::uint16_t>((1U << static_cast<unsigned>(bit_depth)) - 1);
        const Samples dn(41, most);
        Bytes packed(packed_bytes(dn.size(), bit_depth));
        pack_bits(dn, bit_depth, packed);
        EXPECT_EQ(packed, pack_plainly(dn, bit_depth)) << bit_depth;
    }
}

// GenICam PFNC 2.3, Mono12p: two pixels in three bytes, the first one in the low bits.
TEST(BitPackingTest, TwelveBitsAreMono12p) {
    Bytes packed(3);
    pack_bits(Samples{0xABC, 0x123}, 12, packed);
    EXPECT_EQ(packed, (Bytes{0xBC, 0x3A, 0x12}));
}

TEST(BitPackingTest, UnusedBitsOfTheLastByteAreIgnored) {
    Samples dn(1);
    unpack_bits(Bytes{0xFF, 0xFE}, 10, dn);
    EXPECT_EQ(dn[0], 0x2FF);
}

}  // namespace
}  // namespace stipple
