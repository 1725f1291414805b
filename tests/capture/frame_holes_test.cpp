#include "capture/frame_payload.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace stipple {
namespace {

using Holes = std::vector<std::pair<std::size_t, std::size_t>>;

/// A buffer into which packets of `packet` bytes were written, except those of `missing`.
struct Received {
    std::vector<std::uint8_t> truth;
    std::vector<std::uint8_t> buffer;
    Received(std::size_t bytes, std::size_t packet, const std::vector<std::size_t>& missing,
             unsigned seed)
        : truth(bytes), buffer(bytes) {
        std::mt19937 random(seed);
        for (auto& byte : truth) byte = static_cast<std::uint8_t>(random());
        mark_unwritten(buffer);
        for (std::size_t at = 0, number = 0; at < bytes; at += packet, ++number) {
            if (std::find(missing.begin(), missing.end(), number) != missing.end()) continue;
            std::copy_n(truth.begin() + static_cast<std::ptrdiff_t>(at),
                        std::min(packet, bytes - at),
                        buffer.begin() + static_cast<std::ptrdiff_t>(at));
        }
    }
};

TEST(FrameHolesTest, AFrameThatWasWrittenWholeHasNone) {
    Received frame(20000, 1364, {}, 1);
    EXPECT_TRUE(clear_holes(frame.buffer).empty());
    EXPECT_EQ(frame.buffer, frame.truth);
}

TEST(FrameHolesTest, MissingPacketsAreFoundClearedAndTheRestIsUntouched) {
    for (unsigned seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE(seed);
        // 1364: what a packet of 1400 bytes holds, no multiple of 8. The last packet has 904 bytes.
        Received frame(20000, 1364, {0, 5, 6, 14}, seed);
        const Holes holes = clear_holes(frame.buffer);
        const Holes expected{{0, 1364}, {5 * 1364, 7 * 1364}, {14 * 1364, 20000}};
        ASSERT_EQ(holes.size(), expected.size());
        for (std::size_t i = 0; i < holes.size(); ++i) {
            // A byte beside the hole is like the pattern by chance, 1 in 256: then it goes too.
            EXPECT_LE(holes[i].first, expected[i].first);
            EXPECT_GE(holes[i].first + 3, expected[i].first);
            EXPECT_GE(holes[i].second, expected[i].second);
            EXPECT_LE(holes[i].second, expected[i].second + 3);
        }
        for (std::size_t at = 0; at < frame.truth.size(); ++at) {
            const bool missing = std::any_of(holes.begin(), holes.end(), [&](const auto& hole) {
                return at >= hole.first && at < hole.second;
            });
            ASSERT_EQ(frame.buffer[at], missing ? 0 : frame.truth[at]) << "byte " << at;
        }
    }
}

TEST(FrameHolesTest, AShortLastPacketIsFound) {
    Received frame(1364 + 5, 1364, {1}, 2);
    const Holes holes = clear_holes(frame.buffer);
    ASSERT_EQ(holes.size(), 1U);
    EXPECT_EQ(holes[0].second, 1369U);
    EXPECT_LE(holes[0].first, 1364U);
    EXPECT_EQ(std::count(frame.buffer.end() - 5, frame.buffer.end(), 0), 5);
}

TEST(FrameHolesTest, ABufferThatNothingWasWrittenToIsOneHole) {
    std::vector<std::uint8_t> buffer(1001);
    mark_unwritten(buffer);
    EXPECT_EQ(clear_holes(buffer), (Holes{{0, 1001}}));
    EXPECT_EQ(buffer, std::vector<std::uint8_t>(1001));
}

}  // namespace
}  // namespace stipple
