#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "tests/capture/recording/recordings.h"
#include "tests/support/byte_edits.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

/// A recording of 6 small frames, its bytes, and where each of its 8 blocks begins.
struct Sample {
    Sample() {
        RecordingWriter writer(folder / "good", test_session());
        for (const CapturedFrame& frame : frames) {
            starts.push_back(writer.bytes_written());
            writer.write(frame);
        }
        starts.push_back(writer.bytes_written());
        writer.finish({});
        bytes = read_text(folder / "good");
    }
    RecordingReader reader(const std::string& content) const {
        write_text(folder / "bad", content);
        return RecordingReader(folder / "bad");
    }
    /// Frames of `frames` that `content` still holds, in order.
    std::vector<std::uint64_t> ids(RecordingReader& reader) const {
        std::vector<std::uint64_t> result;
        for (const CapturedFrame& frame : read_frames(reader)) {
            EXPECT_TRUE(same(frame, frames.at(frame.record.id)));
            result.push_back(frame.record.id);
        }
        return result;
    }
    TemporaryFolder folder;
    std::vector<CapturedFrame> frames = test_frames(6);
    std::vector<std::uint64_t> starts;  ///< of the frames, then of the end
    std::string bytes;
};

TEST(RecordingDamageTest, AFrameThatIsCompleteHasTheBytesOfItsLayout) {
    const TemporaryFolder folder;
    for (const auto status : {FrameStatus::kComplete, FrameStatus::kSizeMismatch}) {
        auto frames = test_frames(3);
        frames[1].payload.pop_back();
        frames[1].record.status = status;
        write_recording(folder / "a", frames);
        RecordingReader reader(folder / "a");
        const bool damaged = status == FrameStatus::kComplete;
        EXPECT_EQ(read_frames(reader).size(), damaged ? 2U : 3U);
        ASSERT_EQ(reader.report().damage.size(), damaged ? 2U : 0U);  // and the block is missing
        if (damaged)
            expect_parts(reader.report().damage[0].cause, {"119 of the 120 bytes of its layout"});
    }
}

TEST(RecordingDamageTest, EveryPrefixHoldsItsWholeFrames) {
    const Sample sample;
    for (std::size_t length = sample.starts[0]; length < sample.bytes.size(); length += 37) {
        auto reader = sample.reader(sample.bytes.substr(0, length));
        const auto whole =
            std::upper_bound(sample.starts.begin() + 1, sample.starts.end(), length) -
            (sample.starts.begin() + 1);
        EXPECT_EQ(sample.ids(reader).size(), static_cast<std::size_t>(whole)) << length;
        EXPECT_TRUE(reader.report().damage.empty()) << length;
        EXPECT_EQ(reader.report().tail_bytes,
                  length - sample.starts[static_cast<std::size_t>(whole)])
            << length;
        EXPECT_FALSE(reader.end());
    }
}

TEST(RecordingDamageTest, ABadByteCostsOneFrameAtMostAndIsReported) {
    const Sample sample;
    for (std::size_t at = kRecordingMagic.size(); at < sample.bytes.size(); at += 11) {
        auto reader = sample.reader(flipped(sample.bytes, at));
        const auto ids = sample.ids(reader);
        const bool in_a_frame = at >= sample.starts.front() && at < sample.starts.back();
        EXPECT_EQ(ids.size(), in_a_frame ? 5U : 6U) << at;
        EXPECT_TRUE(!reader.report().damage.empty() || reader.report().tail_bytes > 0) << at;
    }
}

TEST(RecordingDamageTest, BytesThatAreMissingCostTheFramesThatTheyHit) {
    const Sample sample;
    auto reader =
        sample.reader(without(sample.bytes, sample.starts[2] + 100, sample.starts[2] + 160));
    EXPECT_EQ(sample.ids(reader), (std::vector<std::uint64_t>{0, 1, 3, 4, 5}));
    EXPECT_EQ(reader.report().missing_blocks, 1U);
    EXPECT_TRUE(reader.end());
}

TEST(RecordingDamageTest, AFrameThatIsCutOutWholeIsMissed) {
    const Sample sample;
    auto reader = sample.reader(without(sample.bytes, sample.starts[2], sample.starts[4]));
    EXPECT_EQ(sample.ids(reader), (std::vector<std::uint64_t>{0, 1, 4, 5}));
    EXPECT_EQ(reader.report().missing_blocks, 2U);
    ASSERT_EQ(reader.report().damage.size(), 1U);
    expect_parts(reader.report().damage[0].cause, {"2 blocks are missing"});
}

TEST(RecordingDamageTest, BytesInBetweenCostNothing) {
    const Sample sample;
    std::string bytes = sample.bytes;
    bytes.insert(sample.starts[3], std::string(300000, '\xC5'));
    auto reader = sample.reader(bytes);
    EXPECT_EQ(sample.ids(reader).size(), 6U);
    ASSERT_EQ(reader.report().damage.size(), 1U);
    EXPECT_EQ(reader.report().damage[0].offset, sample.starts[3]);
    EXPECT_EQ(reader.report().damage[0].bytes, 300000U);
}

TEST(RecordingDamageTest, BytesBehindTheEndAreReportedHoweverFew) {
    const Sample sample;
    for (const std::size_t more : {1U, 31U, 32U, 100U}) {
        auto reader = sample.reader(sample.bytes + std::string(more, 'x'));
        EXPECT_EQ(sample.ids(reader).size(), 6U);
        EXPECT_TRUE(reader.end());
        ASSERT_EQ(reader.report().damage.size(), 1U) << more;
        EXPECT_EQ(reader.report().damage[0].offset, sample.bytes.size());
        EXPECT_EQ(reader.report().damage[0].bytes, more);
        EXPECT_EQ(reader.report().tail_bytes, 0U);
    }
}

}  // namespace
}  // namespace stipple
