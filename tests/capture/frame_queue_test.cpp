#include "capture/frame_queue.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/capture/scripted_camera.h"

namespace stipple {
namespace {

using std::chrono::milliseconds;

/// Of 8 bytes.
CapturedFrame numbered(std::uint64_t id) {
    return scripted_frame(id);
}

TEST(FrameQueueTest, FramesComeOutInTheirOrder) {
    FrameQueue queue(10, 1000);
    for (std::uint64_t id = 0; id < 3; ++id) EXPECT_TRUE(queue.push(numbered(id)));
    for (std::uint64_t id = 0; id < 3; ++id) EXPECT_EQ(queue.pop()->record.wire_id, id);
    EXPECT_FALSE(queue.pop(milliseconds(0)));
    EXPECT_EQ(queue.peak(), 3U);
    EXPECT_FALSE(queue.ended());
}

TEST(FrameQueueTest, NoMoreFramesThanItHoldsAreTaken) {
    FrameQueue queue(2, 1000);
    EXPECT_TRUE(queue.push(numbered(0)));
    EXPECT_TRUE(queue.push(numbered(1)));
    CapturedFrame frame = numbered(2);
    EXPECT_FALSE(queue.push(std::move(frame)));
    EXPECT_EQ(frame.payload.size(), 8U);  // NOLINT(bugprone-use-after-move): it was not taken
    static_cast<void>(queue.pop());
    EXPECT_TRUE(queue.push(std::move(frame)));
}

TEST(FrameQueueTest, NoMoreBytesThanItHoldsAreTakenButOneFrameIs) {
    FrameQueue queue(10, 20);
    EXPECT_TRUE(queue.push(numbered(0)));
    EXPECT_TRUE(queue.push(numbered(1)));
    EXPECT_FALSE(queue.push(numbered(2)));
    FrameQueue small(10, 1);
    EXPECT_TRUE(small.push(numbered(0)));
    EXPECT_FALSE(small.push(numbered(1)));
}

TEST(FrameQueueTest, ClosedItGivesWhatItHoldsAndTakesNoMore) {
    FrameQueue queue(10, 1000);
    queue.push(numbered(0));
    queue.close();
    EXPECT_FALSE(queue.push(numbered(1)));
    EXPECT_FALSE(queue.ended());
    EXPECT_TRUE(queue.pop());
    EXPECT_TRUE(queue.ended());
    EXPECT_FALSE(queue.pop());
}

TEST(FrameQueueTest, ClearedItSaysHowManyFramesWereDropped) {
    FrameQueue queue(10, 1000);
    for (std::uint64_t id = 0; id < 3; ++id) queue.push(numbered(id));
    EXPECT_EQ(queue.close_and_clear(), 3U);
    EXPECT_TRUE(queue.ended());
}

TEST(FrameQueueTest, EachFrameIsEitherTakenOrRefused) {
    FrameQueue queue(4, 1000);
    std::uint64_t received = 0, last = 0;
    std::thread consumer([&] {
        while (const auto frame = queue.pop()) {
            EXPECT_TRUE(received == 0 || frame->record.wire_id > last);
            last = frame->record.wire_id;
            ++received;
        }
    });
    std::uint64_t refused = 0;
    for (std::uint64_t id = 0; id < 5000; ++id) refused += queue.push(numbered(id)) ? 0U : 1U;
    queue.close();
    consumer.join();
    EXPECT_EQ(received + refused, 5000U);
}

}  // namespace
}  // namespace stipple
