#include "capture/recording/recording_writer.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "core/error.h"
#include "tests/capture/recording/recordings.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

TEST(RecordingQueueTest, WhatFitsIsWrittenInOrder) {
    const TemporaryFolder folder;
    const auto frames = test_frames(50);
    RecordingWriter writer(folder / "a", test_session());
    std::size_t given_back = 0;  // the queue's thread, until it is drained
    RecordingQueue queue(
        writer, {.bytes = std::size_t{1} << 20U},
        [&](std::vector<std::uint8_t>&& payload) { given_back += payload.empty() ? 0U : 1U; });
    for (CapturedFrame frame : frames) EXPECT_TRUE(queue.push(std::move(frame)));
    queue.drain();
    EXPECT_EQ(given_back, frames.size());
    writer.finish({});
    RecordingReader reader(folder / "a");
    EXPECT_TRUE(same(read_frames(reader), frames));
    EXPECT_EQ(queue.dropped(), 0U);
}

/// A pipe as a disk that stands still until somebody reads it.
class StandingDisk {
  public:
    explicit StandingDisk(const std::filesystem::path& path) {
        EXPECT_EQ(mkfifo(path.c_str(), 0600), 0);
        descriptor_ = open(path.c_str(), O_RDWR | O_CLOEXEC);
    }
    ~StandingDisk() { close(descriptor_); }
    StandingDisk(const StandingDisk&) = delete;
    StandingDisk& operator=(const StandingDisk&) = delete;

    /// Takes bytes until `done`, the writer's end, says that there are no more, into `file`.
    void copy_to(const std::filesystem::path& file, const std::atomic<bool>& done) const {
        std::ofstream out(file, std::ios::binary);
        fcntl(descriptor_, F_SETFL, O_NONBLOCK);
        std::vector<char> bytes(65536);
        for (bool last = false;;) {
            const auto got = read(descriptor_, bytes.data(), bytes.size());
            if (got > 0) out.write(bytes.data(), got);
            if (got > 0) continue;
            if (last) return;
            last = done;
            std::this_thread::yield();
        }
    }

  private:
    int descriptor_;
};

/// A camera that tells in each frame how many before it were dropped.
struct CountingCamera {
    bool push_next(RecordingQueue& queue) {
        CapturedFrame frame = test_frame(next++, "Mono8", 200, 100);
        frame.record.lost_before = lost;
        if (lost > 0) frame.record.cause = GapCause::kQueueDrop;
        const bool taken = queue.push(std::move(frame));
        lost = taken ? 0 : lost + 1;
        return taken;
    }
    std::uint64_t next = 0;
    std::uint64_t lost = 0;
};

TEST(RecordingQueueTest, ADiskThatStandsStillCostsFramesThatAreCounted) {
    const TemporaryFolder folder;
    const StandingDisk disk(folder / "pipe");
    RecordingWriter writer(folder / "pipe", test_session());
    // A pipe takes 64 KiB; frames of 20 000 bytes; four of them wait.
    RecordingQueue queue(writer, {.bytes = 80000});
    CountingCamera camera;
    std::uint64_t dropped = 0;
    for (int i = 0; i < 40; ++i) dropped += camera.push_next(queue) ? 0U : 1U;
    EXPECT_GT(dropped, 20U);
    EXPECT_EQ(queue.dropped(), dropped);

    std::atomic<bool> done = false;
    std::thread reader([&] { disk.copy_to(folder / "copy", done); });
    while (!camera.push_next(queue)) std::this_thread::yield();
    queue.drain();
    writer.finish({.lost = writer.totals().lost});
    done = true;
    reader.join();

    RecordingReader recording(folder / "copy");
    std::uint64_t expected = 0;
    std::uint64_t lost = 0;
    for (CapturedFrame frame; recording.next(frame); ++expected) {
        expected += frame.record.lost_before;
        lost += frame.record.lost_before;
        EXPECT_EQ(frame.record.id, expected);  // every id is a frame or a counted loss
    }
    EXPECT_EQ(expected, camera.next);
    EXPECT_EQ(lost, queue.dropped());
    ASSERT_TRUE(recording.end());
    EXPECT_EQ(recording.end()->lost[4], lost);
}

TEST(RecordingQueueTest, AFullDiskEndsTheRecordingWithItsLastWholeFrame) {
    const TemporaryFolder folder;
    std::string message;
    {
        RecordingWriter writer(folder / "a", test_session(), "clip.strec");
        RecordingQueue queue(writer, {.bytes = std::size_t{1} << 24U});
        const FileSizeLimit full_disk(100'000);
        for (std::uint64_t i = 0; i < 20; ++i) queue.push(test_frame(i, "Mono8", 200, 100));
        message = message_of<DeviceError>([&] {
            queue.drain();
            return 0;
        });
        EXPECT_TRUE(queue.failed());
        EXPECT_FALSE(queue.push(test_frame(20, "Mono8", 200, 100)));
        EXPECT_EQ(writer.totals().frames + queue.dropped(), 21U);
        writer.finish({.reason = "disk full"});  // 4 frames of 20 192 bytes leave room for it
    }
    expect_parts(message, {"clip.strec", "File too large"});
    RecordingReader reader(folder / "a");
    EXPECT_EQ(read_frames(reader).size(), 4U);
    EXPECT_TRUE(reader.report().damage.empty());
    ASSERT_TRUE(reader.end());
    EXPECT_EQ(reader.end()->reason, "disk full");
}

}  // namespace
}  // namespace stipple
