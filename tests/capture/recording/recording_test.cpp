#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/capture/recording/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

CapturedFrame frame_with_everything() {
    CapturedFrame frame = test_frame(7, "Mono8", 9, 4);
    FrameRecord& record = frame.record;
    record.id = std::uint64_t{1} << 40U;
    record.epoch = 3;
    record.lost_before = 12;
    record.cause = GapCause::kReconnect;
    record.status = FrameStatus::kMissingPackets;
    record.stamp_source = StampSource::kHostEndOfFrame;
    record.device_ns = -5;
    record.exposure_us = 123.25;
    record.gain = 0.0;
    record.layout.offset_x = 16;
    record.layout.offset_y = 2;
    frame.holes = {{0, 4}, {8, 12}, {30, 36}};
    return frame;
}

TEST(RecordingTest, EveryFieldOfAFrameComesBack) {
    const TemporaryFolder folder;
    const std::vector<CapturedFrame> frames{test_frame(1), frame_with_everything(), test_frame(9)};
    write_recording(folder / "a", frames);
    RecordingReader reader(folder / "a");
    EXPECT_TRUE(same(read_frames(reader), frames));
    EXPECT_TRUE(reader.report().damage.empty());
    EXPECT_EQ(reader.report().tail_bytes, 0U);
}

TEST(RecordingTest, TheSessionComesBack) {
    const TemporaryFolder folder;
    write_recording(folder / "a", {});
    const RecordingReader reader(folder / "a");
    const SessionRecord expected = test_session();
    const SessionRecord& session = reader.session();
    EXPECT_EQ(session.camera.transport, expected.camera.transport);
    EXPECT_EQ(session.camera.address, expected.camera.address);
    EXPECT_EQ(session.camera.model, expected.camera.model);
    EXPECT_EQ(session.camera.genicam_xml_hash, expected.camera.genicam_xml_hash);
    EXPECT_EQ(session.camera.features, expected.camera.features);
    EXPECT_EQ(session.camera.transport_facts, expected.camera.transport_facts);
    EXPECT_EQ(session.settings, expected.settings);
    EXPECT_EQ(session.host, expected.host);
    EXPECT_EQ(session.started_realtime_ns, expected.started_realtime_ns);
}

TEST(RecordingTest, TheEndHoldsTotalsLossesAndClock) {
    const TemporaryFolder folder;
    RecordingWriter writer(folder / "a", test_session());
    for (const CapturedFrame& frame : test_frames(10)) writer.write(frame);
    writer.write(frame_with_everything());
    EXPECT_EQ(writer.totals().lost[5], 12U);
    writer.finish({.reason = "camera lost",
                   .lost = {0, 1, 2, 3, 4, 12, 13},
                   .transport = {.underruns = 5, .packets_resent = 6}});
    RecordingReader reader(folder / "a");
    EXPECT_EQ(read_frames(reader).size(), 11U);
    ASSERT_TRUE(reader.end());
    const RecordingEnd& end = *reader.end();
    EXPECT_EQ(end.reason, "camera lost");
    EXPECT_EQ(end.lost, (LostFrames{0, 1, 2, 3, 4, 12, 13}));
    EXPECT_EQ(end.transport.underruns, 5U);
    EXPECT_EQ(end.transport.packets_resent, 6U);
    EXPECT_EQ(end.frames, 11U);
    EXPECT_EQ(end.incomplete, 1U);
    EXPECT_EQ(end.payload_bytes, 10U * 12 * 5 * 2 + 36);
    ASSERT_EQ(end.clocks.size(), 1U);  // the frame with a stamp of the host has no device clock
    EXPECT_EQ(end.clocks[0].frames, 10U);
    EXPECT_EQ(end.clocks[0].offset_ns, 77'000);
}

TEST(RecordingTest, AFrameWithTooManyHolesKeepsThemAllInTheLast) {
    const TemporaryFolder folder;
    CapturedFrame frame = test_frame(0, "Mono16", 400, 400);
    for (std::size_t i = 0; i < 70000; ++i) frame.holes.emplace_back(4 * i, 4 * i + 2);
    write_recording(folder / "a", {frame});
    RecordingReader reader(folder / "a");
    const auto frames = read_frames(reader);
    ASSERT_EQ(frames.size(), 1U);
    ASSERT_EQ(frames[0].holes.size(), kMaxHoles);
    EXPECT_EQ(frames[0].holes.front(), frame.holes.front());
    EXPECT_EQ(frames[0].holes.back().first, 4 * (kMaxHoles - 1));
    EXPECT_EQ(frames[0].holes.back().second, frame.holes.back().second);
}

TEST(RecordingTest, EachClockOfAStampIsRead) {
    const TemporaryFolder folder;
    auto frames = test_frames(5);
    for (std::size_t i = 0; i < frames.size(); ++i)
        frames[i].record.stamp_source = static_cast<StampSource>(i);
    ASSERT_EQ(frames.back().record.stamp_source, StampSource::kUnnamedClock);
    write_recording(folder / "a", frames);
    RecordingReader reader(folder / "a");
    EXPECT_TRUE(same(read_frames(reader), frames));
}

TEST(RecordingTest, ItCanBeReadTwice) {
    const TemporaryFolder folder;
    write_recording(folder / "a", test_frames(3));
    RecordingReader reader(folder / "a");
    const auto first = read_frames(reader);
    reader.rewind();
    EXPECT_TRUE(same(read_frames(reader), first));
    EXPECT_EQ(reader.report().frames, 3U);
}

TEST(RecordingTest, OtherFilesAreRefusedByName) {
    const TemporaryFolder folder;
    write_text(folder / "text", "not a recording at all");
    expect_parts(message_of<InputError>([&] { return RecordingReader(folder / "text"); }),
                 {"text", "not a recording"});
    write_recording(folder / "a", {});
    std::string bytes = read_text(folder / "a");
    bytes[kRecordingVersionOffset] = 2;
    write_text(folder / "new", bytes);
    expect_parts(message_of<InputError>([&] { return RecordingReader(folder / "new"); }),
                 {"new", "version 2"});
}

}  // namespace
}  // namespace stipple
