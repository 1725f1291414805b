// Runs in the virtual machine of tests/vm/boot.py, on vivid as tests/vm/vivid loads it: losses and
// errors that the driver injects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <thread>

#include "core/error.h"
#include "tests/vm/vivid_camera.h"

namespace stipple {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

TEST(VividErrorsTest, FramesThatTheDriverDropsAreGapsOfTheSequence) {
    const auto camera = open_video(0, still({{"percentage_of_dropped_buffers", "30"}}), 8);
    camera->start();
    std::uint64_t last = frame_from(*camera).record.wire_id;
    int gaps = 0;
    for (int i = 0; i < 200 && gaps < 3; ++i) {
        // vivid numbers frames by its clock: on a slow machine it may give a number twice.
        const std::uint64_t id = frame_from(*camera).record.wire_id;
        ASSERT_GE(id, last);
        gaps += id > last + 1 ? 1 : 0;
        last = id;
    }
    EXPECT_EQ(gaps, 3);
    control(0, "percentage_of_dropped_buffers", "0");
}

TEST(VividErrorsTest, ASlowProgramLosesFramesToFullBuffersAndIsTold) {
    const auto camera = open_video(0, still(), 2);
    camera->start();
    for (int i = 0; i < 50 && camera->counts().underruns == 0; ++i) {
        std::this_thread::sleep_for(100ms);  // busy elsewhere
        for (int k = 0; k < 4; ++k) static_cast<void>(frame_from(*camera));
    }
    EXPECT_GT(camera->counts().underruns, 0);
}

TEST(VividErrorsTest, SequenceNumbersWrap) {
    const auto camera = open_video(0, still({{"wrap_sequence_number", "1"}}), 8);
    camera->start();
    constexpr std::uint64_t kHalf = std::uint64_t{1} << 31U;
    std::uint64_t last = frame_from(*camera).record.wire_id;
    EXPECT_GT(last, kHalf);
    for (int i = 0; i < 300 && last > kHalf; ++i) {
        const std::uint64_t id = frame_from(*camera).record.wire_id;
        ASSERT_LT((id - last) % camera->wire_id_period(), 1000);
        last = id;
    }
    EXPECT_LT(last, 1000);
    control(0, "wrap_sequence_number", "0");
}

TEST(VividErrorsTest, AnErrorFlagMarksOneFrame) {
    const auto camera = open_video(0, still());
    camera->start();
    static_cast<void>(frame_from(*camera));
    control(0, "inject_v4l2_buf_flag_error");
    int damaged = 0;
    for (int i = 0; i < 20; ++i)
        damaged += frame_from(*camera).record.status == FrameStatus::kDeviceError ? 1 : 0;
    EXPECT_EQ(damaged, 1);
}

TEST(VividErrorsTest, ABufferThatTheDriverRefusesOnceIsNotLost) {
    const auto camera = open_video(0, still(), 2);
    camera->start();
    for (int i = 0; i < 3; ++i) {  // more often than there are buffers
        control(0, "inject_vidioc_qbuf_error");
        for (int k = 0; k < 3; ++k) static_cast<void>(frame_from(*camera));
    }
}

TEST(VividErrorsTest, RefusedBuffersAndStartsAreErrorsOnce) {
    for (const char* const error :
         {"inject_vidioc_reqbufs_error", "inject_vidioc_streamon_error"}) {
        control(0, error);
        EXPECT_THROW(open_video(0, still())->start(), DeviceError) << error;
        const auto camera = open_video(0, still());
        camera->start();
        static_cast<void>(frame_from(*camera));
    }
}

std::string reason_of_loss(Camera& camera) {
    for (int i = 0; i < 100; ++i) {
        const Arrival arrival = arrival_from(camera);
        if (const auto* const lost = std::get_if<DeviceLost>(&arrival)) return lost->reason;
    }
    return "not lost";
}

TEST(VividErrorsTest, AFatalErrorEndsTheStreamUntilItIsStartedAgain) {
    const auto camera = open_video(0, still());
    camera->start();
    static_cast<void>(frame_from(*camera));
    control(0, "inject_fatal_streaming_error");
    EXPECT_THAT(reason_of_loss(*camera), HasSubstr(std::strerror(EIO)));
    camera->stop();
    camera->start();
    EXPECT_EQ(frame_from(*camera).record.status, FrameStatus::kComplete);
}

TEST(VividErrorsTest, ACameraThatIsUnpluggedIsLostAndOpensAgainOnceItIsBack) {
    auto camera = open_video(0, still());
    camera->start();
    const auto before = frame_from(*camera).payload;
    control(0, "disconnect");
    EXPECT_THAT(reason_of_loss(*camera), HasSubstr(std::strerror(ENODEV)));
    camera.reset();
    camera = open_video(0, still());
    camera->start();
    EXPECT_EQ(frame_from(*camera).payload, before);
}

}  // namespace
}  // namespace stipple
