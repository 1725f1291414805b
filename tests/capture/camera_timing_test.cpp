#include "capture/camera.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

using namespace std::chrono_literals;

CameraDescription camera_with(std::map<std::string, std::string> features) {
    CameraDescription camera;
    camera.features = std::move(features);
    return camera;
}

TEST(CameraTimingTest, ThePeriodIsThatOfTheRateOrOfALongerExposure) {
    EXPECT_EQ(nominal_period(camera_with({{"AcquisitionFrameRate", "200"}})), 5ms);
    EXPECT_EQ(nominal_period(camera_with({{"ExposureTime", "7000"}})), 7ms);
    EXPECT_EQ(
        nominal_period(camera_with({{"AcquisitionFrameRate", "200"}, {"ExposureTimeAbs", "7000"}})),
        7ms);
    for (const char* const text : {"", "fast", "-1", "0", "nan"})
        EXPECT_EQ(nominal_period(camera_with({{"AcquisitionFrameRate", text}})), 0ms) << text;
    EXPECT_EQ(nominal_period({}), 0ms);
}

/// Frames before one with this id, which came so long after the start of a stream of ids from 1 on.
std::uint64_t before(const CameraDescription& camera, std::uint64_t wire_id,
                     std::chrono::nanoseconds since_start) {
    constexpr std::int64_t kStartNs = 1'000'000'000;
    FrameRecord first;
    first.wire_id = wire_id;
    first.host_monotonic_ns = kStartNs + since_start.count();
    return frames_before_first(camera, {.first_wire_id = 1, .monotonic_ns = kStartNs}, first);
}

TEST(CameraTimingTest, FramesBeforeTheFirstNeedTheTimeToBeSent) {
    const CameraDescription camera = camera_with({{"AcquisitionFrameRate", "100"}});
    EXPECT_EQ(before(camera, 1, 1s), 0U);
    EXPECT_EQ(before(camera, 0, 1s), 0U);
    EXPECT_EQ(before(camera, 11, 101ms), 10U);
    EXPECT_EQ(before(camera, 11, 92ms), 10U);  // within the tolerance
    EXPECT_EQ(before(camera, 11, 90ms), 0U);
    EXPECT_EQ(before(camera, 65535, 2s), 0U);
    EXPECT_EQ(before(camera, ~std::uint64_t{0}, 24h), 0U);
    EXPECT_EQ(before(camera, 2, -1s), 0U);
}

TEST(CameraTimingTest, WithoutAPeriodNothingIsMissing) {
    EXPECT_EQ(before({}, 11, 10s), 0U);
    EXPECT_EQ(
        before(camera_with({{"AcquisitionFrameRate", "100"}, {"TriggerMode", "On"}}), 11, 10s), 0U);
}

}  // namespace
}  // namespace stipple
