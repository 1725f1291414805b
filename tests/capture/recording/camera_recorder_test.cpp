#include "capture/recording/camera_recorder.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/error.h"
#include "tests/capture/recording/recordings.h"
#include "tests/capture/scripted_session.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

/// Frames that no session has numbered yet.
std::deque<ScriptedStep> scripted(const std::vector<CapturedFrame>& frames) {
    std::deque<ScriptedStep> steps;
    for (const CapturedFrame& frame : frames) steps.push_back(arrives(frame));
    return steps;
}

class CameraRecorderTest : public ::testing::Test {
  protected:
    CameraRecording record(std::deque<ScriptedStep> steps, CameraRecorderOptions options,
                           const CameraRecorder::ProgressCallback& progress) {
        options.session.reconnect = false;
        CameraRecorder recorder(plays({std::move(steps)}, test_session().camera), {{"Gain", "2"}},
                                file_, std::move(options));
        EXPECT_EQ(recorder.description().model, test_session().camera.model);
        EXPECT_EQ(recorder.file(), file_);
        return recorder.record(progress);
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "clip.strec";
};

bool always(std::uint64_t, const SessionTotals&) {
    return true;
}

TEST_F(CameraRecorderTest, TheFileHoldsAsManyFramesAsTheLimit) {
    const auto sent = test_frames(8);
    const CameraRecording recording = record(scripted(sent), {.limits = {.frames = 5}}, always);
    EXPECT_TRUE(recording.kept);
    EXPECT_FALSE(recording.failure);
    EXPECT_FALSE(recording.lost);
    EXPECT_EQ(recording.end.frames, 5U);
    ASSERT_TRUE(recording.frames_hz);
    EXPECT_NEAR(*recording.frames_hz, 200, 1e-9);  // test_frame: 5 ms apart
    RecordingReader reader(file_);
    EXPECT_EQ(reader.session().settings, (CameraSettings{{"Gain", "2"}}));
    const auto read = read_frames(reader);
    ASSERT_EQ(read.size(), 5U);
    for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(read[i].payload, sent[i].payload);
    EXPECT_EQ(reader.end()->reason, "stopped");
}

TEST_F(CameraRecorderTest, FramesThatAreMissingAreCountedInFileAndResult) {
    auto sent = test_frames(6);
    sent.erase(sent.begin() + 2, sent.begin() + 4);
    const CameraRecording recording = record(scripted(sent), {.limits = {.frames = 4}}, always);
    const auto sum = [](const auto& lost) { return std::accumulate(lost.begin(), lost.end(), 0U); };
    EXPECT_EQ(sum(recording.session.lost), 2U);
    RecordingReader reader(file_);
    EXPECT_EQ(read_frames(reader).size(), 4U);
    EXPECT_EQ(sum(reader.end()->lost), 2U);
}

TEST_F(CameraRecorderTest, ACameraThatIsLostLeavesWhatCameBefore) {
    auto steps = scripted(test_frames(3));
    steps.push_back(is_lost("unplugged"));
    int told = 0;
    const CameraRecording recording = record(
        std::move(steps),
        {.tell = [&](const SessionEvent& event) { told += event.index() == 4 ? 1 : 100; }}, always);
    EXPECT_TRUE(recording.kept);
    ASSERT_TRUE(recording.lost);
    EXPECT_EQ(recording.lost->reason, "unplugged");
    EXPECT_EQ(told, 1);  // of DeviceLost
    RecordingReader reader(file_);
    EXPECT_EQ(read_frames(reader).size(), 3U);
    EXPECT_EQ(reader.end()->reason, "camera lost: unplugged");
}

TEST_F(CameraRecorderTest, WithoutAFrameThereIsNoFile) {
    const CameraRecording recording =
        record(scripted(test_frames(3)), {}, [](std::uint64_t frames, const SessionTotals&) {
            EXPECT_EQ(frames, 0U);
            return false;
        });
    EXPECT_FALSE(recording.kept);
    EXPECT_EQ(recording.end.frames, 0U);
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(CameraRecorderTest, AFullDiskEndsTheRecordingWithItsLastWholeFrame) {
    std::vector<CapturedFrame> sent;
    for (std::uint64_t i = 0; i < 20; ++i) sent.push_back(test_frame(i, "Mono8", 200, 100));
    const CameraRecording recording = [&] {
        const FileSizeLimit full_disk(100'000);
        return record(scripted(sent), {}, always);
    }();
    EXPECT_THROW(std::rethrow_exception(recording.failure), DeviceError);
    EXPECT_TRUE(recording.kept);
    EXPECT_EQ(recording.end.frames, 4U);  // of 20 192 bytes
    RecordingReader reader(file_);
    EXPECT_EQ(read_frames(reader).size(), 4U);
    EXPECT_TRUE(reader.report().damage.empty());
}

}  // namespace
}  // namespace stipple
