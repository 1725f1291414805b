#include "capture/recording/replay_camera.h"

#include <gtest/gtest.h>

#include "capture/frame_record.h"
#include "core/error.h"
#include "io/npy_file.h"
#include "tests/capture/pooled_frames.h"
#include "tests/capture/recording/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

std::string address(const std::filesystem::path& path) {
    return "replay:" + path.string();
}

/// Everything that comes until the end.
std::vector<CapturedFrame> play(Camera& camera, std::size_t at_most = 1000) {
    std::vector<CapturedFrame> frames;
    camera.start();
    while (frames.size() < at_most) {
        Arrival arrival = camera.wait(std::chrono::milliseconds(2000));
        if (std::holds_alternative<DeviceLost>(arrival)) break;
        if (auto* const frame = std::get_if<CapturedFrame>(&arrival))
            frames.push_back(std::move(*frame));
    }
    camera.stop();
    return frames;
}

TEST(ReplayCameraTest, ARecordingComesAsItWasRecorded) {
    const TemporaryFolder folder;
    std::vector<CapturedFrame> recorded = test_frames(5);
    recorded[3].record.status = FrameStatus::kMissingPackets;
    recorded[3].record.exposure_us = 12.5;
    recorded[3].holes = {{4, 8}};
    write_recording(folder / "a", recorded);
    const auto camera = open_replay_camera(address(folder / "a"), {}, {});
    EXPECT_EQ(camera->description().transport, "replay");
    EXPECT_EQ(camera->description().model, test_session().camera.model);
    EXPECT_EQ(camera->layout(), recorded[0].record.layout);
    const std::int64_t begin_ns = monotonic_ns();
    const auto played = play(*camera);
    ASSERT_EQ(played.size(), recorded.size());
    for (std::size_t i = 0; i < played.size(); ++i) {
        CapturedFrame expected = recorded[i];
        EXPECT_EQ(played[i].record.wire_id, i);
        expected.record.wire_id = i;
        expected.record.host_monotonic_ns = played[i].record.host_monotonic_ns;
        expected.record.host_realtime_ns = played[i].record.host_realtime_ns;
        EXPECT_TRUE(same(played[i], expected)) << i;
        // 200 frames/s by its stamps, from when the first is waited for: never earlier.
        EXPECT_GE(played[i].record.host_monotonic_ns - begin_ns,
                  static_cast<std::int64_t>(i) * 5'000'000);
    }
}

TEST(ReplayCameraTest, FramesHaveTheMemoryOfThePool) {
    const TemporaryFolder folder;
    write_recording(folder / "a.strec", test_frames(3));
    NpyWriter writer(folder / "a.npy", "a.npy", {4, 6, 1});
    for (int slot = 0; slot < 3; ++slot) writer.write(std::vector<float>(24, 0.5F));
    writer.finish();
    for (const char* const name : {"a.strec", "a.npy"}) {
        const CameraSettings settings{{"AcquisitionFrameRate", "0"}, {"Loop", "1"}};
        const auto camera = open_replay_camera(address(folder / name), settings, {});
        expect_frames_from_pool(*camera, 8);
    }
}

TEST(ReplayCameraTest, AnAddressNamesItsFile) {
    EXPECT_EQ(replayed_file("replay:a:b.strec"), "a:b.strec");
    for (const char* const other : {"replay:", "replay", "replays:a", "gige:replay:a", ""})
        EXPECT_EQ(replayed_file(other), "") << other;
}

TEST(ReplayCameraTest, IdsThatWereLostStayLost) {
    const TemporaryFolder folder;
    auto recorded = test_frames(4);
    recorded[0].record.lost_before = 5;  // before the recording began
    recorded[2].record.lost_before = 3;
    write_recording(folder / "a", recorded);
    const auto camera = open_replay_camera(address(folder / "a"),
                                           {{"AcquisitionFrameRate", "0"}, {"Loop", "1"}}, {});
    std::vector<std::uint64_t> ids;
    for (const CapturedFrame& frame : play(*camera, 9)) ids.push_back(frame.record.wire_id);
    EXPECT_EQ(ids, (std::vector<std::uint64_t>{0, 1, 5, 6, 7, 8, 12, 13, 14}));
}

TEST(ReplayCameraTest, FramesThatDamageHasTakenAreLostToo) {
    const TemporaryFolder folder;
    auto recorded = test_frames(6);
    recorded.erase(recorded.begin() + 2, recorded.begin() + 4);
    write_recording(folder / "a", recorded);
    const auto camera =
        open_replay_camera(address(folder / "a"), {{"AcquisitionFrameRate", "0"}}, {});
    std::vector<std::uint64_t> ids;
    for (const CapturedFrame& frame : play(*camera)) ids.push_back(frame.record.wire_id);
    EXPECT_EQ(ids, (std::vector<std::uint64_t>{0, 1, 4, 5}));
}

TEST(ReplayCameraTest, WhoeverIsLateLosesFramesThatAreCounted) {
    const TemporaryFolder folder;
    write_recording(folder / "a", test_frames(300));
    // A million frames a second: nobody takes them in time.
    const auto camera = open_replay_camera(address(folder / "a"),
                                           {{"AcquisitionFrameRate", "1000000"}}, {.frames = 2});
    const auto played = play(*camera);
    EXPECT_GT(camera->counts().underruns, 0U);
    EXPECT_EQ(played.size() + camera->counts().underruns, 300U);
    for (const CapturedFrame& frame : played)
        EXPECT_EQ(frame.payload, test_frame(frame.record.wire_id).payload);
}

TEST(ReplayCameraTest, FootageComesAsNumbersOfItsFormat) {
    const TemporaryFolder folder;
    {
        NpyWriter writer(folder / "light.npy", "light.npy", {1, 4, 1});
        writer.write(std::vector<float>{0.0F, 0.5F, 1.0F, 3.0F});
        writer.write(std::vector<float>{0.25F, 0.0F, 0.0F, 0.0F});
        writer.finish();
    }
    const CameraSettings fast{{"AcquisitionFrameRate", "0"}};
    const auto frames = play(*open_replay_camera(address(folder / "light.npy"), fast, {}));
    ASSERT_EQ(frames.size(), 2U);
    // round(0.5 x 65535) = 32768 = 0x8000; above 1.0 is full scale.
    EXPECT_EQ(frames[0].payload,
              (std::vector<std::uint8_t>{0, 0, 0x00, 0x80, 0xFF, 0xFF, 0xFF, 0xFF}));
    EXPECT_EQ(frames[1].record.device_ns - frames[0].record.device_ns, 5'000'000);
    const CameraSettings bytes{{"AcquisitionFrameRate", "0"}, {"PixelFormat", "Mono8"}};
    EXPECT_EQ(play(*open_replay_camera(address(folder / "light.npy"), bytes, {}))[0].payload,
              (std::vector<std::uint8_t>{0, 128, 255, 255}));
}

TEST(ReplayCameraTest, WhatItCannotDoIsRefused) {
    const TemporaryFolder folder;
    write_recording(folder / "a", test_frames(1));
    write_recording(folder / "empty", {});
    const auto refusal = [&](const char* name, const CameraSettings& settings) {
        return message_of<InputError>(
            [&] { return open_replay_camera(address(folder / name), settings, {}); });
    };
    expect_parts(refusal("a", {{"ExposureTime", "10"}}),
                 {"ExposureTime", "not a setting of a replay"});
    expect_parts(refusal("a", {{"Loop", "yes"}}), {"Loop", "0 nor 1"});
    expect_parts(refusal("a", {{"AcquisitionFrameRate", "-1"}}), {"AcquisitionFrameRate", "-1"});
    expect_parts(refusal("a", {{"PixelFormat", "Mono8"}}), {"PixelFormat", "Mono16"});
    expect_parts(refusal("empty", {}), {"empty", "no frame"});
    expect_parts(refusal("missing", {}), {"missing"});
    EXPECT_THROW(static_cast<void>(open_replay_camera("replay:", {}, {})), InputError);
}

}  // namespace
}  // namespace stipple
