// Runs in the virtual machine of tests/vm/boot.py, on vivid as tests/vm/vivid loads it: every frame
// of a V4L2 camera accounted for, also over an outage.
#include <gtest/gtest.h>

#include <optional>

#include "capture/capture_session.h"
#include "tests/vm/vivid_camera.h"

namespace stipple {
namespace {

CaptureSession session_of(const CameraSettings& settings) {
    SessionOptions options;
    options.stall = std::chrono::milliseconds(5000);  // the machine is emulated
    options.first_frame = std::chrono::milliseconds(20000);
    return CaptureSession([settings] { return open_video(0, settings, 8); }, options);
}

/// The next frame, and whether an outage and a recovery came before it.
struct Next {
    FrameRecord record;
    bool outage = false;
    bool recovery = false;
};

Next next_frame(CaptureSession& session) {
    Next next;
    for (int i = 0; i < 100; ++i) {
        const SessionEvent event = session.next(std::chrono::seconds(1));
        if (const auto* const frame = std::get_if<CapturedFrame>(&event)) {
            next.record = frame->record;
            return next;
        }
        next.outage = next.outage || std::holds_alternative<Outage>(event);
        next.recovery = next.recovery || std::holds_alternative<Recovery>(event);
        if (const auto* const lost = std::get_if<DeviceLost>(&event))
            throw std::runtime_error("lost: " + lost->reason);
    }
    throw std::runtime_error("no frame");
}

TEST(VividSessionTest, FramesThatTheDriverDroppedAreAccountedFor) {
    CaptureSession session = session_of(still({{"percentage_of_dropped_buffers", "30"}}));
    FrameRecord last = next_frame(session).record;
    const FrameRecord first = last;
    std::uint64_t lost = 0;
    for (int i = 0; i < 60; ++i) {
        const FrameRecord record = next_frame(session).record;
        ASSERT_EQ(record.id, last.id + 1 + record.lost_before);
        ASSERT_EQ(record.cause == GapCause::kNone, record.lost_before == 0);
        lost += record.lost_before;
        last = record;
    }
    EXPECT_GT(lost, 0);
    EXPECT_EQ(last.wire_id - first.wire_id, 60 + lost);
    control(0, "percentage_of_dropped_buffers", "0");
}

TEST(VividSessionTest, AnUnpluggedCameraComesBackAsANewEpochWithItsSettings) {
    CaptureSession session = session_of(still());
    const FrameRecord before = next_frame(session).record;
    control(0, "disconnect");
    std::optional<Next> after;
    for (int i = 0; i < 20 && !after; ++i) {  // frames that were complete before are still given
        const Next next = next_frame(session);
        if (next.outage) after = next;
    }
    ASSERT_TRUE(after.has_value());
    EXPECT_TRUE(after->recovery);
    EXPECT_EQ(after->record.epoch, before.epoch + 1);
    EXPECT_EQ(after->record.layout, before.layout);
    EXPECT_GT(after->record.id, before.id);
    EXPECT_EQ(session.totals().outages, 1);
}

}  // namespace
}  // namespace stipple
