// Emulated ioctl: what V4l2Camera makes of a driver's answers, without a driver (umockdev).
#include "capture/v4l2/v4l2_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <ostream>

#include "core/error.h"
#include "tests/capture/emulated_camera.h"
#include "tests/capture/pooled_frames.h"

namespace stipple {
namespace {

using namespace std::chrono_literals;
using testing::Each;
using testing::HasSubstr;

struct Api {
    const char* name;
    bool multi_planar;
    const char* memory;
};

void PrintTo(const Api& api, std::ostream* out) {
    *out << api.name;
}

class V4l2CameraOfEachApi : public testing::TestWithParam<Api> {
  protected:
    [[nodiscard]] EmulatedDriver driver() const {
        EmulatedDriver driver;
        driver.multi_planar = GetParam().multi_planar;
        return driver;
    }
    [[nodiscard]] std::unique_ptr<Camera> open() const {
        return open_emulated({{"BufferMemory", GetParam().memory}});
    }
};

INSTANTIATE_TEST_SUITE_P(Apis, V4l2CameraOfEachApi,
                         testing::Values(Api{"SingleMapped", false, "driver"},
                                         Api{"SingleUser", false, "own"},
                                         Api{"MultiMapped", true, "driver"},
                                         Api{"MultiUser", true, "own"}),
                         [](const auto& api) { return api.param.name; });

TEST_P(V4l2CameraOfEachApi, GivesTheBytesOfEveryFrame) {
    EmulatedV4l2 emulated(driver());
    constexpr int kFrames = 200;
    for (int i = 0; i < kFrames; ++i) emulated.push(ramp_frame(16 * 8, i));
    const auto camera = open();
    camera->start();
    for (int i = 0; i < kFrames; ++i) {
        const CapturedFrame frame = frame_from(*camera);
        ASSERT_EQ(frame.record.wire_id, i);
        ASSERT_EQ(frame.record.status, FrameStatus::kComplete);
        ASSERT_EQ(frame.payload, ramp(16 * 8, 7 * i));
        ASSERT_TRUE(frame.holes.empty());
    }
    EXPECT_EQ(camera->counts().underruns, 0);
}

TEST_P(V4l2CameraOfEachApi, FramesHaveTheMemoryOfThePool) {
    EmulatedV4l2 emulated(driver());
    for (int i = 0; i < 20; ++i) emulated.push(ramp_frame(16 * 8, i));
    expect_frames_from_pool(*open(), 20);
}

TEST_P(V4l2CameraOfEachApi, LeavesNoStaleBytesInAShortFrame) {
    EmulatedV4l2 emulated(driver());
    for (int i = 0; i < 4; ++i) emulated.push(ramp_frame(128, 100));
    emulated.push(ramp_frame(50, 3));  // reuses the buffer of the first frame
    const auto camera = open();
    camera->start();
    for (int i = 0; i < 4; ++i) static_cast<void>(frame_from(*camera));
    const CapturedFrame frame = frame_from(*camera);
    EXPECT_EQ(frame.record.status, FrameStatus::kSizeMismatch);
    EXPECT_EQ(frame.record.bytes_received, 50);
    auto expected = ramp(50, 21);
    expected.resize(128);
    EXPECT_EQ(frame.payload, expected);
    EXPECT_EQ(frame.holes, (std::vector<std::pair<std::size_t, std::size_t>>{{50, 128}}));
}

TEST_P(V4l2CameraOfEachApi, StreamsAgainAfterAStop) {
    EmulatedV4l2 emulated(driver());
    const auto camera = open();
    for (int i = 0; i < 3; ++i) {
        emulated.push(ramp_frame(128, i));
        camera->start();
        EXPECT_EQ(frame_from(*camera).record.wire_id, i);
        camera->stop();
        EXPECT_FALSE(emulated.streaming());
        EXPECT_EQ(emulated.queued(), 0);
    }
}

TEST_P(V4l2CameraOfEachApi, KeepsThePaddingOfRowsAndDropsThatBehindTheLast) {
    EmulatedDriver padded = driver();
    padded.row_padding = 16;
    padded.frame_padding = 64;
    EmulatedV4l2 emulated(padded);
    constexpr std::size_t kSent = 32 * 8 + 64;
    emulated.push(ramp_frame(kSent, 1));
    const auto camera = open();
    EXPECT_EQ(camera->layout().stride_bytes, 32);
    camera->start();
    const CapturedFrame frame = frame_from(*camera);
    EXPECT_EQ(frame.record.status, FrameStatus::kComplete);
    EXPECT_EQ(frame.record.bytes_received, kSent);
    EXPECT_EQ(frame.payload, ramp(32 * 7 + 16, 7));  // the last row ends with its pixels
}

TEST_P(V4l2CameraOfEachApi, TakesFramesWhoseLastRowHasNoPadding) {
    EmulatedDriver padded = driver();
    padded.row_padding = 16;
    EmulatedV4l2 emulated(padded);
    emulated.push(ramp_frame(32 * 7 + 16, 1));
    const auto camera = open();
    camera->start();
    EXPECT_EQ(frame_from(*camera).record.status, FrameStatus::kComplete);
}

TEST_P(V4l2CameraOfEachApi, RefusesToTrustMoreBytesThanABufferHas) {
    EmulatedV4l2 emulated(driver());
    EmulatedFrame frame = ramp_frame(128, 0);
    frame.bytes_used = 1U << 30U;
    emulated.push(frame);
    const auto camera = open();
    camera->start();
    const CapturedFrame got = frame_from(*camera);
    EXPECT_EQ(got.record.status, FrameStatus::kSizeMismatch);
    EXPECT_EQ(got.record.bytes_received, 128);
    EXPECT_EQ(got.payload.size(), 128);
}

TEST(V4l2CameraTest, SkipsTheHeaderOfAPlane) {
    EmulatedDriver driver;
    driver.multi_planar = true;
    driver.frame_padding = 32;
    EmulatedV4l2 emulated(driver);
    EmulatedFrame frame = ramp_frame(128 + 32, 0);
    frame.data_offset = 32;
    emulated.push(frame);
    frame.data_offset = 1U << 30U;  // behind the buffer
    emulated.push(frame);
    const auto camera = open_emulated();
    camera->start();
    EXPECT_EQ(frame_from(*camera).payload, ramp(128, 32));
    const CapturedFrame damaged = frame_from(*camera);
    EXPECT_EQ(damaged.record.status, FrameStatus::kSizeMismatch);
    EXPECT_THAT(damaged.payload, Each(0));
}

TEST(V4l2CameraTest, MarksFramesThatTheDriverCallsDamaged) {
    EmulatedV4l2 emulated;
    EmulatedFrame frame = ramp_frame(128, 5);
    frame.flags |= V4L2_BUF_FLAG_ERROR;
    emulated.push(frame);
    frame.bytes_used = 0;
    emulated.push(frame);
    emulated.push(ramp_frame(128, 6));
    const auto camera = open_emulated();
    camera->start();
    EXPECT_EQ(frame_from(*camera).record.status, FrameStatus::kDeviceError);
    const CapturedFrame empty = frame_from(*camera);
    EXPECT_EQ(empty.record.status, FrameStatus::kDeviceError);
    EXPECT_THAT(empty.payload, Each(0));
    EXPECT_EQ(frame_from(*camera).record.status, FrameStatus::kComplete);
}

TEST(V4l2CameraTest, NamesTheClockOfStamps) {
    const std::vector<std::pair<std::uint32_t, StampSource>> cases{
        {V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC, StampSource::kHostEndOfFrame},
        {V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE,
         StampSource::kHostStartOfFrame},
        {V4L2_BUF_FLAG_TIMESTAMP_COPY, StampSource::kUnnamedClock},
        {V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN, StampSource::kUnnamedClock}};
    EmulatedV4l2 emulated;
    const auto camera = open_emulated();
    camera->start();
    for (const auto& [flags, source] : cases) {
        EmulatedFrame frame = ramp_frame(128, 0);
        frame.flags = flags;
        frame.stamp = {12, 345678};
        emulated.push(frame);
        const FrameRecord record = frame_from(*camera).record;
        EXPECT_EQ(record.stamp_source, source);
        EXPECT_EQ(record.device_ns, 12'345'678'000);
    }
}

TEST(V4l2CameraTest, CountsLossesWhileAllBuffersWereFull) {
    // Four frames filled all four buffers; 10 numbers are missing before the fifth.
    EmulatedV4l2 emulated;
    for (const int number : {0, 1, 2, 3, 14, 15}) emulated.push(ramp_frame(128, number));
    const auto camera = open_emulated();
    camera->start();
    for (int i = 0; i < 6; ++i) static_cast<void>(frame_from(*camera));
    EXPECT_EQ(camera->counts().underruns, 10);
}

TEST(V4l2CameraTest, CountsNoLossOfOursWhileBuffersWereFree) {
    EmulatedV4l2 emulated;
    const auto camera = open_emulated();
    camera->start();
    for (const int number : {0, 1, 5, 6}) {
        EXPECT_TRUE(std::holds_alternative<NoFrame>(camera->wait(1ms)));
        emulated.push(ramp_frame(128, number));
        EXPECT_EQ(frame_from(*camera).record.wire_id, number);
    }
    EXPECT_EQ(camera->counts().underruns, 0);
}

TEST(V4l2CameraTest, SequenceNumbersMayWrap) {
    EmulatedV4l2 emulated;
    for (const std::uint32_t number : {0xFFFFFFFEU, 0xFFFFFFFFU, 0U, 1U}) {
        EmulatedFrame frame = ramp_frame(128, 0);
        frame.sequence = number;
        emulated.push(frame);
    }
    const auto camera = open_emulated({}, 2);
    EXPECT_EQ(camera->wire_id_period(), 1ULL << 32U);
    camera->start();
    for (const std::uint64_t number : {0xFFFFFFFEU, 0xFFFFFFFFU, 0U, 1U})
        EXPECT_EQ(frame_from(*camera).record.wire_id, number);
    EXPECT_EQ(camera->counts().underruns, 0);
}

TEST(V4l2CameraTest, OffersABufferAgainThatTheDriverRefusedOnce) {
    EmulatedV4l2 emulated;
    for (int i = 0; i < 8; ++i) emulated.push(ramp_frame(128, i));
    const auto camera = open_emulated();
    camera->start();
    emulated.fail(VIDIOC_QBUF, {EINVAL});
    for (int i = 0; i < 8; ++i) EXPECT_EQ(frame_from(*camera).record.wire_id, i);
    EXPECT_EQ(emulated.queued(), 4);
}

TEST(V4l2CameraTest, GoesOnWhereTheDriverRefusedAllBuffersOnce) {
    EmulatedV4l2 emulated;
    for (int i = 0; i < 6; ++i) emulated.push(ramp_frame(128, i));
    const auto camera = open_emulated({}, 2);
    camera->start();
    emulated.fail(VIDIOC_QBUF, {EINVAL, EINVAL, EINVAL});  // one of the first frame, both then
    for (int i = 0; i < 6; ++i) EXPECT_EQ(frame_from(*camera).record.wire_id, i);
}

TEST(V4l2CameraTest, AFailedFetchIsTheEndOfTheStream) {
    for (const int error : {EIO, ENODEV, EINVAL, EPIPE}) {
        EmulatedV4l2 emulated;
        const auto camera = open_emulated();
        camera->start();
        emulated.fail(VIDIOC_DQBUF, {error});
        const Arrival arrival = camera->wait(5s);
        ASSERT_TRUE(std::holds_alternative<DeviceLost>(arrival));
        EXPECT_THAT(std::get<DeviceLost>(arrival).reason, HasSubstr(std::strerror(error)));
    }
}

TEST(V4l2CameraTest, ADeviceThatIsGoneCanBeClosed) {
    EmulatedV4l2 emulated;
    auto camera = open_emulated();
    camera->start();
    emulated.fail(VIDIOC_DQBUF, {ENODEV});
    emulated.fail(VIDIOC_STREAMOFF, {ENODEV});
    emulated.fail(VIDIOC_REQBUFS, {ENODEV});
    EXPECT_TRUE(std::holds_alternative<DeviceLost>(camera->wait(5s)));
    camera.reset();
    EXPECT_EQ(emulated.calls(VIDIOC_STREAMOFF), 1);
    EXPECT_EQ(emulated.calls(VIDIOC_REQBUFS), 2);
}

TEST(V4l2CameraTest, StartsAgainAfterTheDriverRefusedOnce) {
    EmulatedV4l2 emulated;
    const auto camera = open_emulated();
    emulated.fail(VIDIOC_STREAMON, {EINVAL});
    EXPECT_THROW(camera->start(), DeviceError);
    emulated.push(ramp_frame(128, 0));
    camera->start();
    EXPECT_EQ(frame_from(*camera).record.wire_id, 0);
}

TEST(V4l2CameraTest, GoesOnAfterSignals) {
    EmulatedV4l2 emulated;
    emulated.fail(VIDIOC_DQBUF, {EINTR, EINTR});
    emulated.fail(VIDIOC_STREAMON, {EINTR});
    emulated.push(ramp_frame(128, 0));
    const auto camera = open_emulated();
    camera->start();
    EXPECT_EQ(frame_from(*camera).record.wire_id, 0);
}

TEST(V4l2CameraTest, SaysThatNothingArrived) {
    EmulatedV4l2 emulated;
    const auto camera = open_emulated();
    camera->start();
    EXPECT_TRUE(std::holds_alternative<NoFrame>(camera->wait(20ms)));
}

}  // namespace
}  // namespace stipple
