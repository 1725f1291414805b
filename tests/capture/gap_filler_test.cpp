#include "capture/frame_sequence.h"

#include <gtest/gtest.h>

#include <vector>

namespace stipple {
namespace {

FrameRecord frame(std::uint64_t id, std::uint64_t lost_before = 0) {
    FrameRecord record;
    record.id = id;
    record.lost_before = lost_before;
    return record;
}

TEST(GapFillerTest, FramesWithoutGapsHoldNothing) {
    GapFiller filler;
    for (const std::uint64_t id : {7U, 8U, 9U}) {
        const GapFiller::Gap gap = filler.next(frame(id));
        EXPECT_EQ(gap.lost, 0U);
        EXPECT_EQ(gap.held, 0U);
    }
}

TEST(GapFillerTest, EachMissingFrameIsAHeldSlot) {
    GapFiller filler;
    static_cast<void>(filler.next(frame(0)));
    const GapFiller::Gap gap = filler.next(frame(4, 3));
    EXPECT_EQ(gap.lost, 3U);
    EXPECT_EQ(gap.held, 3U);
}

// A damaged file has lost frames whose loss no record tells; ids that restart tell nothing.
TEST(GapFillerTest, OfRecordAndIdsTheLargerNumberCounts) {
    GapFiller filler;
    static_cast<void>(filler.next(frame(10)));
    EXPECT_EQ(filler.next(frame(13)).held, 2U);
    EXPECT_EQ(filler.next(frame(14, 5)).held, 5U);
    EXPECT_EQ(filler.next(frame(3, 1)).held, 1U);
    EXPECT_EQ(filler.next(frame(3)).held, 0U);
}

TEST(GapFillerTest, AFrameThatIsNotUsedIsAHeldSlotToo) {
    GapFiller filler;
    static_cast<void>(filler.next(frame(0)));
    const GapFiller::Gap gap = filler.next(frame(3, 2), false);
    EXPECT_EQ(gap.lost, 2U);
    EXPECT_EQ(gap.held, 3U);
    EXPECT_EQ(filler.next(frame(4)).held, 0U);
}

TEST(GapFillerTest, NothingIsHeldBeforeTheFirstUsedFrame) {
    GapFiller filler;
    EXPECT_EQ(filler.next(frame(5, 5), false).held, 0U);
    const GapFiller::Gap first = filler.next(frame(8));
    EXPECT_EQ(first.lost, 2U);
    EXPECT_EQ(first.held, 0U);
    EXPECT_EQ(filler.next(frame(10)).held, 1U);
}

// With one slot for each used frame, the slots from the first used frame to the last one are the
// ids from the one to the other.
TEST(GapFillerTest, SlotsKeepTheTimeOfTheirFrames) {
    struct Sent {
        std::uint64_t id;
        bool is_used;
    };
    GapFiller filler;
    std::uint64_t slots = 0;
    for (const Sent& sent : std::vector<Sent>{
             {2, false}, {3, true}, {4, true}, {9, false}, {10, false}, {12, true}, {20, true}}) {
        slots += filler.next(frame(sent.id), sent.is_used).held + (sent.is_used ? 1 : 0);
    }
    EXPECT_EQ(slots, 20U - 3U + 1U);
}

TEST(GapFillerTest, SumsOfGapsDoNotOverflow) {
    GapFiller filler;
    static_cast<void>(filler.next(frame(0)));
    const GapFiller::Gap gap = filler.next(frame(1, ~std::uint64_t{0}), false);
    EXPECT_EQ(gap.lost, ~std::uint64_t{0});
    EXPECT_EQ(gap.held, (std::uint64_t{1} << 40U) + 1);
}

}  // namespace
}  // namespace stipple
