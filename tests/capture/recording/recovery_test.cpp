#include "capture/recording/recovery.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "core/error.h"
#include "tests/capture/recording/recordings.h"
#include "tests/stream/stream_files.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

class RecoveryTest : public ::testing::Test {
  protected:
    /// The file of a run that was killed after three frames and 100 bytes of the next one.
    void leave_recording() const {
        RecordingWriter writer(partial_, test_session());
        for (const CapturedFrame& frame : test_frames(3)) writer.write(frame);
        const std::uint64_t whole = writer.bytes_written();
        writer.write(test_frame(3));
        fs::resize_file(partial_, whole + 100);
    }

    TemporaryFolder folder_;
    fs::path partial_ = folder_ / ".clip.1-2.partial";
    fs::path output_ = folder_ / "clip";
};

TEST_F(RecoveryTest, ARecordingKeepsItsWholeFrames) {
    leave_recording();
    EXPECT_EQ(recoverable(partial_), Recoverable::kRecording);
    int checks = 0;
    const Recovered recovered = recover(partial_, output_, [&] { ++checks; });
    EXPECT_EQ(checks, 3);
    EXPECT_EQ(recovered.kind, Recoverable::kRecording);
    EXPECT_EQ(recovered.whole, 3U);
    EXPECT_EQ(recovered.cut_bytes, 100U);
    EXPECT_FALSE(recovered.complete);
    EXPECT_FALSE(fs::exists(partial_));
    RecordingReader reader(output_);
    EXPECT_TRUE(same(read_frames(reader), test_frames(3)));
    EXPECT_EQ(reader.report().tail_bytes, 0U);
}

TEST_F(RecoveryTest, ACompleteStreamKeepsItsEnd) {
    const StreamHeader header = varied_header();
    write_stream(partial_, header, random_packets(header, 6, header.shape.rows));
    EXPECT_EQ(recoverable(partial_), Recoverable::kStream);
    const Recovered recovered = recover(partial_, output_, [] {});
    EXPECT_EQ(recovered.whole, 6U);
    EXPECT_EQ(recovered.cut_bytes, 0U);
    EXPECT_TRUE(recovered.complete);
}

TEST_F(RecoveryTest, NothingIsReplacedOrCutWhereTheNameIsTaken) {
    leave_recording();
    const auto bytes = fs::file_size(partial_);
    std::ofstream(output_) << "somebody's";
    EXPECT_THROW(static_cast<void>(recover(partial_, output_, [] {})), InputError);
    EXPECT_EQ(fs::file_size(partial_), bytes);
    EXPECT_EQ(fs::file_size(output_), 10U);
}

TEST_F(RecoveryTest, GivenUpItLeavesEverythingAsItWas) {
    leave_recording();
    const auto bytes = fs::file_size(partial_);
    const auto give_up = [] { throw std::runtime_error("stop"); };
    EXPECT_THROW(static_cast<void>(recover(partial_, output_, give_up)), std::runtime_error);
    EXPECT_EQ(fs::file_size(partial_), bytes);
    EXPECT_FALSE(fs::exists(output_));
}

TEST_F(RecoveryTest, OtherFilesAreRefused) {
    std::ofstream(partial_) << "no stream";
    EXPECT_EQ(recoverable(partial_), Recoverable::kNo);
    EXPECT_THROW(static_cast<void>(recover(partial_, output_, [] {})), InputError);
    EXPECT_EQ(recoverable(folder_.path()), Recoverable::kNo);
}

}  // namespace
}  // namespace stipple
