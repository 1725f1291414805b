// Emulated ioctl: what V4l2Camera makes of a driver's answers, without a driver (umockdev).
#include "capture/v4l2_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <memory>
#include <numeric>
#include <ostream>

#include "core/error.h"
#include "tests/capture/emulated_v4l2.h"

namespace stipple {
namespace {

using namespace std::chrono_literals;
using testing::Each;
using testing::HasSubstr;

std::vector<std::uint8_t> ramp(std::size_t size, int first) {
    std::vector<std::uint8_t> bytes(size);
    std::iota(bytes.begin(), bytes.end(), static_cast<std::uint8_t>(first));
    return bytes;
}

EmulatedFrame ramp_frame(std::size_t size, int number) {
    EmulatedFrame frame;
    frame.content = ramp(size, 7 * number);
    frame.sequence = static_cast<std::uint32_t>(number);
    return frame;
}

std::unique_ptr<Camera> open_emulated(const CameraSettings& settings = {}, int frames = 4) {
    return open_v4l2_camera("v4l2:/dev/video0", settings, {.frames = frames});
}

CapturedFrame frame_from(Camera& camera) {
    Arrival arrival = camera.wait(5s);
    if (auto* const lost = std::get_if<DeviceLost>(&arrival))
        throw std::runtime_error("lost: " + lost->reason);
    return std::get<CapturedFrame>(std::move(arrival));
}

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

TEST(V4l2CameraTest, SaysThatNothingArrived) {
    EmulatedV4l2 emulated;
    const auto camera = open_emulated();
    camera->start();
    EXPECT_TRUE(std::holds_alternative<NoFrame>(camera->wait(20ms)));
}

}  // namespace
}  // namespace stipple
