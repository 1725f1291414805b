// Emulated ioctl (tests/capture/v4l2): a V4L2 device in the window.
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "capture/recording/recording_reader.h"
#include "study/report/report_page.h"
#include "tests/capture/emulated_camera.h"
#include "tests/support/temporary_folder.h"
#include "view/viewed_camera.h"

namespace stipple {
namespace {

constexpr int kRows = 8, kCols = 16;

void wait_until(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!condition() && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ASSERT_TRUE(condition());
}

TEST(V4l2ViewTest, FramesAreShownAndRecorded) {
    const TemporaryFolder folder;
    EmulatedV4l2 device;
    ViewedCamera camera(
        {.address = "v4l2:/dev/video0",
         .open = [](const CameraSettings& settings) { return open_emulated(settings); },
         .folder = folder.path()});
    int pushed = 0;
    const auto push = [&](int frames) {
        for (const int end = pushed + frames; pushed < end; ++pushed)
            device.push(ramp_frame(kRows * kCols, pushed));
        wait_until([&] {
            const auto status = camera.status();
            return status["frames"] == pushed &&
                   status["skipped"].get<int>() + camera.recent().extent().slots == pushed;
        });
    };
    push(5);
    camera.record();
    push(40);
    camera.stop_recording();
    push(5);
    wait_until([&] { return folder.names().size() == 1 && folder.names()[0].ends_with(".strec"); });
    EXPECT_EQ(camera.status()["lost"]["queue_drop"], 0);

    RecordingReader reader(folder / folder.names()[0]);
    int recorded = 0;
    for (CapturedFrame frame; reader.next(frame); ++recorded)
        EXPECT_EQ(std::vector(frame.payload.begin(), frame.payload.end()),
                  ramp(kRows * kCols, 7 * (5 + recorded)));
    EXPECT_EQ(recorded, 40);

    const std::int64_t shown = camera.recent().extent().slots;
    EXPECT_GT(shown, 0);
    std::vector<float> light;
    for (const std::uint8_t dn : ramp(kRows * kCols, 7 * (pushed - 1)))
        light.push_back(static_cast<float>(dn) / 255);
    EXPECT_EQ(camera.recent().codes(shown - 1), light_codes(light));
}

}  // namespace
}  // namespace stipple
