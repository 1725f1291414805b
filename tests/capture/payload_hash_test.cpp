#include "capture/frame_payload.h"

#include <gtest/gtest.h>

#include <string_view>

namespace stipple {
namespace {

std::uint64_t hash_of(std::string_view text) {
    return payload_hash({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

// The hash of nothing, from the test vectors of xxHash 0.8.
TEST(PayloadHashTest, IsXxh3OfSeed0) {
    EXPECT_EQ(hash_of(""), 0x2D06800538D394C2U);
}

TEST(PayloadHashTest, ChangesWithEachByteAndWithTheLength) {
    EXPECT_NE(hash_of("frame"), hash_of("frame "));
    EXPECT_NE(hash_of("frame"), hash_of("Frame"));
    EXPECT_EQ(hash_of("frame"), hash_of("frame"));
}

}  // namespace
}  // namespace stipple
