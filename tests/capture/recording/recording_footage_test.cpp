#include "capture/recording/recording_footage.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/capture/recording/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Floats = std::vector<float>;

/// A frame of two pixels, Mono12p.
CapturedFrame two_pixels(unsigned left, unsigned right) {
    CapturedFrame frame = test_frame(0, "Mono12p", 2, 1);
    frame.payload = {static_cast<std::uint8_t>(left),
                     static_cast<std::uint8_t>(left >> 8U | right << 4U),
                     static_cast<std::uint8_t>(right >> 4U)};
    return frame;
}

std::vector<Floats> read_all(RecordingFootage& footage) {
    std::vector<Floats> frames;
    for (Floats frame(footage.shape().sites()); footage.read(frame);) frames.push_back(frame);
    return frames;
}

TEST(RecordingFootageTest, LightIsTheShareOfFullScaleAboveBlack) {
    const TemporaryFolder folder;
    write_recording(folder / "a", {two_pixels(4095, 95), two_pixels(1095, 0)});
    RecordingFootage plain(folder / "a");
    EXPECT_EQ(plain.shape(), (FrameShape{1, 2, 1}));
    EXPECT_EQ(read_all(plain)[0], (Floats{1.0F, static_cast<float>(95.0 / 4095)}));
    RecordingFootage above(folder / "a", {.black_level_dn = 95});
    EXPECT_EQ(read_all(above), (std::vector<Floats>{{1.0F, 0.0F}, {0.25F, 0.0F}}));
}

TEST(RecordingFootageTest, ColourComesPlaneByPlane) {
    const TemporaryFolder folder;
    CapturedFrame frame = test_frame(0, "RGB8", 2, 1);
    frame.payload = {255, 0, 51, 0, 255, 51};
    write_recording(folder / "a", {frame});
    RecordingFootage footage(folder / "a");
    EXPECT_EQ(footage.shape(), (FrameShape{1, 2, 3}));
    EXPECT_EQ(read_all(footage)[0], (Floats{1, 0, 0, 1, 0.2F, 0.2F}));
}

/// Frames 0, 1, (2 and 3 missing), 4, an incomplete 5, 6; the left pixel is the number.
void write_gaps(const std::filesystem::path& file) {
    std::vector<CapturedFrame> frames;
    for (const unsigned id : {0U, 1U, 4U, 5U, 6U}) {
        frames.push_back(two_pixels(id, 0));
        if (id == 4) frames.back().record.lost_before = 2;
        if (id == 5) frames.back().record.status = FrameStatus::kMissingPackets;
    }
    frames[0].record.lost_before = 9;
    write_recording(file, frames);
}

std::vector<int> numbers(RecordingFootage& footage) {
    std::vector<int> result;
    for (const Floats& frame : read_all(footage))
        result.push_back(static_cast<int>(frame[0] * 4095 + 0.5F));
    return result;
}

TEST(RecordingFootageTest, TheFrameBeforeStandsInForMissingOnes) {
    const TemporaryFolder folder;
    write_gaps(folder / "a");
    RecordingFootage footage(folder / "a");
    EXPECT_EQ(numbers(footage), (std::vector<int>{0, 1, 1, 1, 4, 4, 6}));
    EXPECT_EQ(footage.held_slots(), 3U);
    RecordingFootage skipping(folder / "a", {.hold_missing = false});
    EXPECT_EQ(numbers(skipping), (std::vector<int>{0, 1, 4, 6}));
    RecordingFootage keeping(folder / "a", {.drop_incomplete = false});
    EXPECT_EQ(numbers(keeping), (std::vector<int>{0, 1, 1, 1, 4, 5, 6}));
}

TEST(RecordingFootageTest, FramesThatDamageHasTakenAreMissingToo) {
    const TemporaryFolder folder;
    std::vector<CapturedFrame> frames;
    for (const unsigned id : {0U, 1U, 4U}) {  // 2 and 3 were in the file
        frames.push_back(two_pixels(id, 0));
        frames.back().record.id = id;
    }
    write_recording(folder / "a", frames);
    RecordingFootage footage(folder / "a");
    EXPECT_EQ(numbers(footage), (std::vector<int>{0, 1, 1, 1, 4}));
    EXPECT_EQ(footage.missing_frames(), 2U);
    EXPECT_TRUE(footage.at_end());
}

TEST(RecordingFootageTest, AnotherLayoutAndEndlessGapsAreErrors) {
    const TemporaryFolder folder;
    write_recording(folder / "a", {two_pixels(1, 2), test_frame(1, "Mono8", 2, 1)});
    expect_parts(message_of<InputError>([&] {
                     RecordingFootage footage(folder / "a");
                     return read_all(footage);
                 }),
                 {"another region or pixel format"});
    auto far = two_pixels(1, 2);
    far.record.lost_before = ~std::uint64_t{0};
    write_recording(folder / "b", {two_pixels(1, 2), far});
    expect_parts(message_of<InputError>([&] {
                     RecordingFootage footage(folder / "b");
                     return read_all(footage);
                 }),
                 {"skip_gaps = true"});
    EXPECT_THROW(RecordingFootage(folder / "b", {.black_level_dn = 4095}), InputError);
    write_recording(folder / "c", {});
    EXPECT_THROW(RecordingFootage(folder / "c", {}), InputError);
}

}  // namespace
}  // namespace stipple
