#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/videoio.hpp>

#include "core/error.h"
#include "io/frame_writer.h"
#include "io/tone_map.h"
#include "tests/io/test_images.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Floats = std::vector<float>;

/// Flat frames, one a light level, the same in all planes.
void write_levels(const std::filesystem::path& file, FrameShape shape, const Floats& levels) {
    FrameWriter writer(file, shape);
    for (const float level : levels) writer.write(Floats(shape.sites(), level));
    writer.finish();
}

/// Texture that is another one in each slot, and takes many bytes.
Floats textured_frame(FrameShape shape, std::size_t slot) {
    Floats frame(shape.sites());
    for (std::size_t i = 0; i < frame.size(); ++i)
        frame[i] = static_cast<float>((i * 7919 + slot * 31) % 101) / 50.0F;
    return frame;
}

class VideoFileTest : public testing::TestWithParam<const char*> {
  protected:
    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / (std::string("clip") + GetParam());
};

TEST_P(VideoFileTest, ReadsBackToneMappedLevels) {
    const Floats levels = {0, 0.18F, 1, 2, 4};
    for (const int planes : {1, 3}) {
        const FrameShape shape{34, 50, planes};
        write_levels(file_, shape, levels);
        FootageReader reader(file_);
        EXPECT_EQ(reader.shape(), (FrameShape{34, 50, 3}));
        Floats frame(reader.shape().sites());
        for (const float level : levels) {
            ASSERT_TRUE(reader.read(frame));
            // Lossy: video range has 219 levels for 255, and the quantiser adds a few.
            for (const float value : frame)
                ASSERT_NEAR(value, tone_mapped(level) / 255.0, 6 / 255.0) << "level " << level;
        }
        EXPECT_FALSE(reader.read(frame));
        std::filesystem::remove(file_);
    }
}

TEST_P(VideoFileTest, KeepsRedAndBlueApart) {
    const FrameShape shape{32, 32, 3};
    Floats red(shape.sites(), 0.0F);
    std::fill_n(red.begin(), shape.pixels(), 1.0F);
    FrameWriter writer(file_, shape);
    writer.write(red);
    writer.finish();
    const Floats frame = read_all(file_);
    EXPECT_NEAR(frame[500], tone_mapped(1) / 255.0, 0.05);
    EXPECT_NEAR(frame[500 + 2 * shape.pixels()], 0.0, 0.05);
}

TEST_P(VideoFileTest, PadsOddAndNarrowSizes) {
    const std::pair<FrameShape, FrameShape> sizes[] = {{{33, 47, 1}, {34, 48, 3}},
                                                       {{1, 1, 3}, {2, 4, 3}}};
    for (const auto& [shape, padded] : sizes) {
        write_levels(file_, shape, {1, 1, 1});
        const FootageReader reader(file_);
        EXPECT_EQ(reader.shape(), padded);
        std::filesystem::remove(file_);
    }
}

TEST_P(VideoFileTest, WritesTheFrameRate) {
    for (const double rate : {0.01, 12.5, 29.97, 240.0}) {
        FrameWriter writer(file_, {32, 32, 1}, {.video = {.frames_hz = rate}, .force = true});
        for (int i = 0; i < 5; ++i) writer.write(Floats(32 * 32, 1.0F));
        writer.finish();
        cv::VideoCapture capture(file_.string(), cv::CAP_FFMPEG);
        EXPECT_NEAR(capture.get(cv::CAP_PROP_FPS), rate, 1e-5 * rate);
        EXPECT_NEAR(FootageReader(file_).frames_hz().value(), rate, 1e-5 * rate);
        EXPECT_EQ(read_all(file_).size(), std::size_t{5 * 3 * 32 * 32});
    }
}

// Frames that refer to later ones are stored out of order: FFmpeg mistakes the start of such a
// stream.
TEST_P(VideoFileTest, ReadsBackReorderedFramesOfAnyRate) {
    const FrameShape shape{26, 34, 1};
    for (const double rate : {0.01, 0.333, 24.0}) {
        FrameWriter writer(file_, shape, {.video = {.frames_hz = rate}, .force = true});
        for (std::size_t slot = 0; slot < 12; ++slot) writer.write(textured_frame(shape, slot));
        writer.finish();
        EXPECT_EQ(read_all(file_).size(), std::size_t{12 * 3 * 26 * 34}) << rate;
    }
}

TEST_P(VideoFileTest, RefusesATruncatedVideoWhateverItsLength) {
    const FrameShape shape{64, 64, 1};
    {
        FrameWriter writer(file_, shape);
        for (std::size_t slot = 0; slot < 40; ++slot) writer.write(textured_frame(shape, slot));
        writer.finish();
    }
    const std::string whole = read_text(file_);
    for (const int percent : {1, 10, 30, 50, 70}) {
        write_text(file_, whole.substr(0, whole.size() * static_cast<std::size_t>(percent) / 100));
        testing::internal::CaptureStderr();
        const auto message = message_of<InputError>([&] { read_all(file_); });
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
        expect_parts(message, {file_.string() + ": ", "damaged"});
    }
}

TEST_P(VideoFileTest, WritesNothingToStderr) {
    testing::internal::CaptureStderr();
    write_levels(file_, {32, 32, 3}, {0, 1});
    read_all(file_);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

INSTANTIATE_TEST_SUITE_P(Formats, VideoFileTest, testing::Values(".mp4", ".mkv"),
                         [](const auto& format) { return std::string(format.param + 1); });

}  // namespace
}  // namespace stipple
