// Footage and recordings as sources of frames.
#include <gtest/gtest.h>

#include <array>

#include "capture/serve/served_frames.h"
#include "core/error.h"
#include "tests/capture/recording/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(FootageFramesTest, FullScaleIsLightOneAndTheRestIsClipped) {
    const std::array<float, 5> light{0.0F, 0.5F, 1.0F, 2.0F, 0.001F};
    std::array<std::uint16_t, 5> dn{};
    quantise_light(light, {1, 5, 1}, 10, dn);
    // 0.5 x 1023 = 511.5 rounds up, 0.001 x 1023 = 1.023.
    EXPECT_EQ(dn, (std::array<std::uint16_t, 5>{0, 512, 1023, 1023, 1}));
}

TEST(FootageFramesTest, IntegersOfAnyDepthComeBack) {
    for (const int bits : {8, 10, 12, 16})
        for (int value = 0; value < 1 << bits; ++value) {
            const float light = static_cast<float>(value) / static_cast<float>((1 << bits) - 1);
            std::uint16_t dn = 0;
            quantise_light(std::span(&light, 1), {1, 1, 1}, bits, std::span(&dn, 1));
            ASSERT_EQ(dn, value) << bits;
        }
}

TEST(FootageFramesTest, PlanesAreInterleaved) {
    const std::array<float, 6> light{0.0F, 1.0F, 0.2F, 0.4F, 0.6F, 0.8F};  // R R G G B B
    std::array<std::uint16_t, 6> dn{};
    quantise_light(light, {1, 2, 3}, 8, dn);
    EXPECT_EQ(dn, (std::array<std::uint16_t, 6>{0, 51, 153, 255, 102, 204}));
}

class RecordingFramesTest : public ::testing::Test {
  protected:
    std::filesystem::path write(const std::vector<CapturedFrame>& frames) {
        const auto file = folder_.path() / "clip.strec";
        RecordingWriter writer(file, test_session());
        for (const CapturedFrame& frame : frames) writer.write(frame);
        writer.finish({});
        return file;
    }
    static std::vector<ServedFrame> all_of(FrameSource& source) {
        source.start(*source.image().formats.front());
        std::vector<ServedFrame> frames;
        while (auto frame = source.next()) frames.push_back(std::move(*frame));
        return frames;
    }
    TemporaryFolder folder_;
};

TEST_F(RecordingFramesTest, BytesStampsAndRateAreThoseOfTheRecording) {
    const auto recorded = test_frames(6);
    const auto file = write(recorded);
    EXPECT_TRUE(is_recording(file));
    RecordingFrames source(file);
    EXPECT_NEAR(source.image().frames_hz, 200, 1e-9);
    for (int round = 0; round < 2; ++round) {  // each start is from the first frame on
        const auto served = all_of(source);
        ASSERT_EQ(served.size(), 6U);
        for (std::size_t i = 0; i < 6; ++i) {
            EXPECT_EQ(served[i].number, i);
            EXPECT_EQ(served[i].payload, recorded[i].payload);
            EXPECT_EQ(served[i].stamp_ns, static_cast<std::uint64_t>(recorded[i].record.device_ns));
        }
    }
}

TEST_F(RecordingFramesTest, MissingAndIncompleteFramesAreLeftOutOfTheNumbers) {
    auto recorded = test_frames(8);
    recorded[5].record.status = FrameStatus::kMissingPackets;
    recorded.erase(recorded.begin() + 2);
    RecordingFrames source(write(recorded));
    std::vector<std::uint64_t> numbers;
    for (const ServedFrame& frame : all_of(source)) numbers.push_back(frame.number);
    EXPECT_EQ(numbers, (std::vector<std::uint64_t>{0, 1, 3, 4, 6, 7}));
}

TEST_F(RecordingFramesTest, PaddingOfRowsIsTakenOut) {
    CapturedFrame frame = test_frame(0, "Mono8", 4, 3);
    frame.record.layout.stride_bytes = 7;
    frame.payload = {1, 2, 3, 4, 0, 0, 0, 5, 6, 7, 8, 0, 0, 0, 9, 10, 11, 12};
    RecordingFrames source(write({frame}));
    const auto served = all_of(source);
    ASSERT_EQ(served.size(), 1U);
    EXPECT_EQ(served[0].payload, (Bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
}

TEST_F(RecordingFramesTest, WhatCannotBeServedIsRefused) {
    EXPECT_THROW(RecordingFrames(write({})), InputError);
    auto changing = test_frames(2);
    changing.push_back(test_frame(2, "Mono16", 10, 5));
    RecordingFrames source(write(changing));
    EXPECT_THROW(all_of(source), InputError);
    EXPECT_FALSE(is_recording(folder_.path()));
    EXPECT_FALSE(is_recording(folder_.path() / "absent"));
}

}  // namespace
}  // namespace stipple
