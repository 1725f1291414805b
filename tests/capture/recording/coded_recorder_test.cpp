#include "capture/recording/coded_recorder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "capture/serve/coded_payload.h"
#include "core/error.h"
#include "core/gap_limit.h"
#include "tests/capture/scripted_camera.h"
#include "tests/stream/stream_files.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

class CodedRecorderTest : public ::testing::Test {
  protected:
    /// A frame with the packets of a slot.
    [[nodiscard]] ScriptedStep slot(std::int64_t number, bool damaged = false) const {
        return frame_of(packets_of(number), damaged);
    }
    [[nodiscard]] ScriptedStep frame_of(const std::vector<SamplePacket>& packets,
                                        bool damaged = false) const {
        CapturedFrame frame;
        frame.payload = coded_payload(packets, coded_header(header_), image_);
        if (damaged) frame.payload.front() ^= 1U;
        return arrives(frame);
    }
    [[nodiscard]] std::vector<SamplePacket> packets_of(std::int64_t number) const {
        return {random_packet(header_, number, 0, header_.shape.rows)};
    }
    [[nodiscard]] SamplePacket dropped(std::int64_t number) const {
        return {number, 0, header_.shape.rows, SamplePacket::kDropped, {}};
    }

    CodedRecording record(std::deque<ScriptedStep> steps, CaptureLimits limits = {},
                          const std::string& frame_count = {}) {
        CameraDescription camera;
        camera.features["CodedStreamHeader"] = image_.coded_header;
        if (!frame_count.empty()) camera.features["SourceFrameCount"] = frame_count;
        steps.push_back(is_lost("end of the script", true));
        CodedRecorder recorder(std::make_unique<ScriptedCamera>(std::move(steps), camera), file_,
                               false, limits);
        slots_ = recorder.slots();
        return recorder.record([](const CodedRecording&) { return true; });
    }
    [[nodiscard]] std::vector<SamplePacket> recorded() const {
        StreamReader reader(file_);
        EXPECT_EQ(reader.header(), header_);
        std::vector<SamplePacket> packets;
        for (SamplePacket packet; reader.next(packet);) packets.push_back(packet);
        EXPECT_TRUE(reader.report().complete);
        return packets;
    }

    StreamHeader header_ = varied_header();
    ServedImage image_ = coded_image(header_);
    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "clip.stipple";
    std::optional<std::int64_t> slots_;
};

TEST_F(CodedRecorderTest, SlotsThatDoNotArriveAreDroppedPackets) {
    const CodedRecording recording = record({slot(0), slot(1), slot(4), slot(5, true)}, {}, "7");
    EXPECT_EQ(slots_, 7);
    EXPECT_TRUE(recording.kept);
    EXPECT_FALSE(recording.failure);
    EXPECT_EQ(recording.slots, 7);
    EXPECT_EQ(recording.missing_slots, 4);
    EXPECT_EQ(recording.damaged_frames, 1);
    const std::vector<SamplePacket> expected{packets_of(0)[0], packets_of(1)[0], dropped(2),
                                             dropped(3),       packets_of(4)[0], dropped(5),
                                             dropped(6)};
    EXPECT_EQ(recorded(), expected);
}

// Slots of four bands, of which so many arrive. What follows them is a dropped packet; a slot is
// missing if nothing of it came.
TEST_F(CodedRecorderTest, ASlotOfWhichTheRestIsLostIsNotMissing) {
    const std::vector<int> bands_that_came{4, 2, 0, 4, 1, 0, 0, 3, 4, 2};
    const int rows = header_.shape.rows;
    std::deque<ScriptedStep> steps;
    std::vector<SamplePacket> expected;
    for (std::int64_t number = 0; number < std::ssize(bands_that_came); ++number) {
        const int came = bands_that_came[static_cast<std::size_t>(number)];
        std::vector<SamplePacket> packets;
        for (int row = 0; row < came; ++row)
            packets.push_back(random_packet(header_, number, row, 1));
        expected.insert(expected.end(), packets.begin(), packets.end());
        if (came < rows)
            expected.push_back({number, came, rows - came, SamplePacket::kDropped, {}});
        if (came > 0) steps.push_back(frame_of(packets));
    }
    const CodedRecording recording = record(std::move(steps), {}, "10");
    EXPECT_EQ(recording.slots, 10);
    EXPECT_EQ(recording.missing_slots, std::ranges::count(bands_that_came, 0));
    EXPECT_EQ(recording.damaged_frames, 0);
    EXPECT_EQ(recorded(), expected);
}

TEST_F(CodedRecorderTest, OfALostCameraThereIsWhatItSent) {
    const CodedRecording recording = record({slot(0), slot(2), is_lost("unplugged")}, {}, "7");
    ASSERT_TRUE(recording.lost);
    EXPECT_EQ(recording.lost->reason, "unplugged");
    EXPECT_TRUE(recording.kept);
    EXPECT_EQ(recording.slots, 3);
    EXPECT_EQ(recorded().size(), 3U);
}

TEST_F(CodedRecorderTest, TheLimitEndsItBeforeTheSource) {
    const CodedRecording recording = record({slot(0), slot(1), slot(2)}, {.frames = 2}, "7");
    EXPECT_EQ(slots_, 2);
    EXPECT_EQ(recording.slots, 2);
    EXPECT_EQ(recording.missing_slots, 0);
    EXPECT_EQ(recorded().size(), 2U);
}

TEST_F(CodedRecorderTest, AStreamThatJumpsTooFarIsKeptUpToThere) {
    const CodedRecording recording = record({slot(0), slot(5'000)});
    EXPECT_EQ(slots_, std::nullopt);
    EXPECT_THROW(std::rethrow_exception(recording.failure), InputError);
    EXPECT_TRUE(recording.kept);
    EXPECT_EQ(recording.slots, 1);
}

TEST_F(CodedRecorderTest, AGapInProportionToTheSlotsThatCameIsFilled) {
    const std::int64_t most = max_missing_slots(2, header_.shape);
    const CodedRecording recording = record({slot(0), slot(1), slot(most + 2)});
    EXPECT_FALSE(recording.failure);
    EXPECT_EQ(recording.missing_slots, most);
    EXPECT_EQ(recording.slots, most + 3);
}

TEST_F(CodedRecorderTest, ACameraThatSendsLittleOfWhatItAnnouncesIsLost) {
    const CodedRecording recording = record({slot(0), slot(1)}, {}, "900000");
    ASSERT_TRUE(recording.lost);
    EXPECT_EQ(recording.lost->reason, "nothing came after slot 2 of 900000");
    EXPECT_EQ(recording.slots, 2);
    EXPECT_EQ(recorded().size(), 2U);  // and an end marker
}

TEST_F(CodedRecorderTest, WithoutASlotThereIsNoFile) {
    const CodedRecording recording = record({});
    EXPECT_FALSE(recording.kept);
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(CodedRecorderTest, ACameraOfImagesIsRefused) {
    EXPECT_THROW(CodedRecorder(std::make_unique<ScriptedCamera>(std::deque<ScriptedStep>{}), file_,
                               false, {}),
                 InputError);
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace stipple
