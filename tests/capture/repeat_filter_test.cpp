#include "capture/frame_ids.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <vector>

#include "tests/capture/scripted_camera.h"

namespace stipple {
namespace {

/// A filter behind frames that were numbered in this order.
class RepeatFilterTest : public testing::Test {
  protected:
    explicit RepeatFilterTest(std::initializer_list<std::uint64_t> wire_ids = {101, 102, 103}) {
        for (const std::uint64_t wire_id : wire_ids) number(scripted_frame(wire_id).record);
    }
    void number(const FrameRecord& record) {
        static_cast<void>(ids_.next(record.wire_id));
        last_ = record;
    }
    RepeatFilter::Sorted take(CapturedFrame frame) {
        return filter_.take(std::move(frame), ids_, &*last_);
    }
    [[nodiscard]] static CapturedFrame stamped(std::uint64_t wire_id, std::int64_t device_ns) {
        CapturedFrame frame = scripted_frame(wire_id);
        frame.record.stamp_source = StampSource::kDeviceClock;
        frame.record.device_ns = device_ns;
        return frame;
    }

    RepeatFilter filter_;
    FrameIds ids_{65535};
    std::optional<FrameRecord> last_;
};

TEST_F(RepeatFilterTest, ANewIdPassesAtOnce) {
    const auto sorted = take(scripted_frame(105));
    ASSERT_TRUE(sorted.next);
    EXPECT_EQ(sorted.next->record.wire_id, 105U);
    EXPECT_FALSE(sorted.left_out);
    EXPECT_FALSE(filter_.take_waiting());
    EXPECT_FALSE(filter_.take_doubtful());
}

TEST_F(RepeatFilterTest, APastIdIsHeldUntilANewOneShowsThatItWasARepeat) {
    const auto held = take(scripted_frame(101));
    EXPECT_FALSE(held.next);
    EXPECT_FALSE(held.left_out);
    const auto sorted = take(scripted_frame(104));
    ASSERT_TRUE(sorted.next && sorted.left_out);
    EXPECT_EQ(sorted.next->record.wire_id, 104U);
    EXPECT_EQ(sorted.left_out->record.wire_id, 101U);
}

TEST_F(RepeatFilterTest, AFrameThatFollowsThePastIdShowsThatTheCounterBeganAnew) {
    static_cast<void>(take(scripted_frame(1)));
    const auto sorted = take(scripted_frame(2));
    ASSERT_TRUE(sorted.next);
    EXPECT_EQ(sorted.next->record.wire_id, 1U);
    EXPECT_FALSE(sorted.left_out);
    const auto waiting = filter_.take_waiting();
    ASSERT_TRUE(waiting);
    EXPECT_EQ(waiting->record.wire_id, 2U);
    EXPECT_FALSE(filter_.take_waiting());
}

TEST_F(RepeatFilterTest, MoreThanEightIdsLaterDoNotFollow) {
    static_cast<void>(take(scripted_frame(1)));
    const auto sorted = take(scripted_frame(10));
    EXPECT_FALSE(sorted.next);  // in doubt, as the one before was
    ASSERT_TRUE(sorted.left_out);
    EXPECT_EQ(sorted.left_out->record.wire_id, 1U);
    EXPECT_EQ(filter_.take_doubtful()->record.wire_id, 10U);
}

TEST_F(RepeatFilterTest, ANewerStampTellsAtOnceThatTheCounterBeganAnew) {
    number(stamped(104, 500).record);
    EXPECT_TRUE(take(stamped(1, 501)).next);
    EXPECT_FALSE(take(stamped(1, 500)).next);  // held: its clock may have begun anew too
    EXPECT_FALSE(take(stamped(2, 499)).next);  // older than the one in doubt, so it does not follow
}

TEST_F(RepeatFilterTest, WithoutStampsACounterMayStand) {
    EXPECT_TRUE(take(scripted_frame(103)).next);
}

TEST_F(RepeatFilterTest, AnIncompleteFrameOfThePastIsLeftOutAtOnce) {
    static_cast<void>(take(scripted_frame(1)));
    CapturedFrame late = scripted_frame(102);
    late.record.status = FrameStatus::kMissingPackets;
    const auto sorted = take(std::move(late));
    EXPECT_FALSE(sorted.next);
    ASSERT_TRUE(sorted.left_out);
    EXPECT_EQ(sorted.left_out->record.wire_id, 102U);
    EXPECT_EQ(filter_.take_doubtful()->record.wire_id, 1U);  // still in doubt
}

TEST_F(RepeatFilterTest, AfterAReconnectionEveryFrameIsNew) {
    EXPECT_TRUE(filter_.take(scripted_frame(1), ids_, nullptr).next);
}

}  // namespace
}  // namespace stipple
