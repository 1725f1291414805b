#include "capture/recording/camera_recorder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <numeric>
#include <thread>
#include <utility>

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
                           const CameraRecorder::Observer& progress) {
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

/// A frame of 2 MB.
ScriptedStep large_frame(std::uint64_t number) {
    auto frame = std::make_shared<CapturedFrame>(test_frame(number, "Mono8", 1, 1));
    FrameLayout& layout = frame->record.layout;
    layout.width = 2000;
    layout.height = 1000;
    layout.stride_bytes = 2000;
    frame->payload.assign(layout.payload_bytes(), static_cast<std::uint8_t>(number));
    frame->record.bytes_received = frame->payload.size();
    return {[frame] { return Arrival(std::move(*frame)); }, {}};
}

std::uintmax_t bytes_in(const std::filesystem::path& folder) {
    std::uintmax_t bytes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        bytes += entry.file_size();
    return bytes;
}

/// Silence until the files of a folder have so many bytes.
ScriptedStep wait_for_bytes(const std::filesystem::path& folder, std::uintmax_t bytes) {
    return {[=] {
                const auto end = std::chrono::steady_clock::now() + kLong;
                while (bytes_in(folder) < bytes && std::chrono::steady_clock::now() < end)
                    std::this_thread::yield();
                return Arrival(NoFrame{});
            },
            {}};
}

// One frame may wait; the first is written before the others come, faster than any disk. The end of
// the file has those that were refused, and those that were taken and did not fit on the disk.
TEST_F(CameraRecorderTest, EachFrameThatArrivesIsInTheFileOrCountedOnce) {
    constexpr auto kQueue = static_cast<std::size_t>(GapCause::kQueueDrop);
    constexpr std::uint64_t kSent = 24;
    for (const bool full : {false, true}) {
        std::deque<ScriptedStep> steps{large_frame(0), wait_for_bytes(folder_.path(), 2'000'000)};
        for (std::uint64_t i = 1; i < kSent; ++i) steps.push_back(large_frame(i));
        steps.push_back(is_lost("end of the script", true));
        const CameraRecording recording = [&] {
            const FileSizeLimit disk(full ? 3'000'000 : 100'000'000);
            return record(std::move(steps), {.queue_bytes = 1}, always);
        }();
        const std::uint64_t refused = recording.session.lost[kQueue];
        EXPECT_EQ(recording.end.frames + recording.end.lost[kQueue],
                  recording.session.frames + refused);
        EXPECT_EQ(recording.failure != nullptr, full);
        if (full) {
            EXPECT_EQ(recording.end.frames, 1U);
        } else {
            EXPECT_GT(refused, 0U) << "the test means something";
            EXPECT_EQ(recording.end.frames + recording.end.lost[kQueue], kSent);
        }
        RecordingReader reader(file_);
        EXPECT_EQ(read_frames(reader).size(), recording.end.frames);
        EXPECT_EQ(reader.end()->lost, recording.end.lost);
        std::filesystem::remove(file_);
    }
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
