#include "core/gap_limit.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

TEST(GapLimitTest, ARecordingOfLargeFramesMayBeginSomeDozensOfSlotsLate) {
    EXPECT_EQ(max_missing_slots(1, {8, 8, 1}), 16 + 1000);
    EXPECT_EQ(max_missing_slots(1, {512, 512, 1}), 16 + 128);
    EXPECT_EQ(max_missing_slots(1, {2160, 3840, 3}), 16 + 48);
}

TEST(GapLimitTest, OfLessThanAMegabyteOfFramesNoMoreThan256MegabytesAreMade) {
    for (const int side : {1, 8, 100, 512, 700, 1000})
        for (int frames = 1; frames * side * side <= 1'000'000; frames *= 2) {
            const std::int64_t slots = frames + max_missing_slots(frames, {side, side, 1});
            EXPECT_LE(slots * side * side * 4, 264'000'000) << side << ' ' << frames;
        }
}

}  // namespace
}  // namespace stipple
