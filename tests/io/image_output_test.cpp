#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <vector>

#include "core/error.h"
#include "io/exr_file.h"
#include "io/frame_writer.h"
#include "io/tiff_writer.h"
#include "tests/io/test_images.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Floats = std::vector<float>;

constexpr FrameShape kShape{3, 5, 3};

Floats ramp(float start) {
    Floats frame(kShape.sites());
    for (std::size_t i = 0; i < frame.size(); ++i) frame[i] = start + 0.02F * static_cast<float>(i);
    return frame;
}

/// Three frames; all their light.
Floats write_three(const std::filesystem::path& output, const FrameWriterOptions& options) {
    FrameWriter writer(output, kShape, options);
    Floats all;
    for (const float start : {0.0F, 0.05F, 1.0F}) {
        const Floats frame = ramp(start);
        writer.write(frame);
        all.insert(all.end(), frame.begin(), frame.end());
    }
    writer.finish();
    return all;
}

TEST(ImageOutputTest, FloatTiffsAreTheLight) {
    const TemporaryFolder folder;
    for (const char* name : {"stack.ome.tif", "stack.tiff", "frames"}) {
        const Floats light = write_three(folder / name, {.images = {.format = ImageFormat::kTiff}});
        EXPECT_EQ(read_all(folder / name), light) << name;
    }
    EXPECT_TRUE(std::filesystem::exists(folder / "frames/light_0002.tif"));
}

TEST(ImageOutputTest, WordsAreTheLightToHalfAStep) {
    const TemporaryFolder folder;
    constexpr double kFullScale = 2;
    for (const char* name : {"stack.tif", "tiffs", "pngs"}) {
        const bool png = std::string(name) == "pngs";
        const Floats light = write_three(
            folder / name, {.images = {.format = png ? ImageFormat::kPng : ImageFormat::kTiff,
                                       .samples = SampleKind::kWord,
                                       .full_scale = kFullScale}});
        const Floats found = read_all(folder / name);
        ASSERT_EQ(found.size(), light.size());
        for (std::size_t i = 0; i < light.size(); ++i)
            EXPECT_NEAR(kFullScale * static_cast<double>(found[i]), light[i],
                        0.5 * kFullScale / 65535 + 1e-7);
    }
    EXPECT_TRUE(std::filesystem::exists(folder / "pngs/light_0002.png"));
}

TEST(ImageOutputTest, WordsClipAndRound) {
    EXPECT_EQ(to_uint16(0, 1), 0);
    EXPECT_EQ(to_uint16(1, 1), 65535);
    EXPECT_EQ(to_uint16(5, 1), 65535);
    EXPECT_EQ(to_uint16(-1, 1), 0);
    EXPECT_EQ(to_uint16(std::nanf(""), 1), 0);
    EXPECT_EQ(to_uint16(std::numeric_limits<float>::infinity(), 1), 65535);
    EXPECT_EQ(to_uint16(0.5F, 1), 32768);
    EXPECT_EQ(to_uint16(2, 4), 32768);
}

TEST(ImageOutputTest, HalfFloatsKeep11Bits) {
    const TemporaryFolder folder;
    const Floats light = write_three(folder / "half", {.images = {.samples = SampleKind::kHalf}});
    const Floats found = read_all(folder / "half");
    ASSERT_EQ(found.size(), light.size());
    for (std::size_t i = 0; i < light.size(); ++i)
        EXPECT_NEAR(found[i], light[i], std::ldexp(static_cast<double>(light[i]), -11) + 1e-7);
    write_exr(folder / "bright.exr", "bright.exr", {1, 2, 1}, Floats{1e6F, 1}, ExrSample::kHalf);
    EXPECT_EQ(read_all(folder / "bright.exr"), (Floats{65504, 1}));
}

TEST(ImageOutputTest, OmeXmlTellsSizesTypeAndTimes) {
    const std::string text = ome_xml({3, 5, 3}, 7,
                                     {.format = ImageFormat::kTiff,
                                      .samples = SampleKind::kWord,
                                      .full_scale = 4,
                                      .slot_s = 0.0005,
                                      .pixel_um = 6.5});
    expect_parts(text, {R"(SizeX="5" SizeY="3" SizeZ="1" SizeC="3" SizeT="7")",
                        R"(TimeIncrement="0.0005")", R"(PhysicalSizeX="6.5" PhysicalSizeY="6.5")",
                        R"(Type="uint16")", "65535 is light 4", R"(SamplesPerPixel="3")"});
    const std::string bare = ome_xml({1, 1, 1}, 1, {.samples = SampleKind::kFloat});
    EXPECT_EQ(bare.find("TimeIncrement"), std::string::npos);
    EXPECT_NE(bare.find(R"(Type="float")"), std::string::npos);
    const TemporaryFolder folder;
    write_three(folder / "stack.tif", {});
    EXPECT_NE(read_text(folder / "stack.tif").find(R"(SizeT="3")"), std::string::npos);
}

TEST(ImageOutputTest, RefusesSamplesThatAFormatDoesNotHave) {
    const TemporaryFolder folder;
    const std::pair<ImageCoding, const char*> cases[] = {
        {{.format = ImageFormat::kPng, .samples = SampleKind::kFloat}, "PNG has integers"},
        {{.format = ImageFormat::kPng, .samples = SampleKind::kHalf}, "PNG has integers"},
        {{.format = ImageFormat::kExr, .samples = SampleKind::kWord}, "EXR has floats"},
        {{.format = ImageFormat::kTiff, .samples = SampleKind::kHalf}, "TIFF is written as"}};
    for (const auto& [images, problem] : cases)
        expect_parts(message_of<InputError>([&, &coding = images] {
                         write_three(folder / "frames", {.images = coding});
                     }),
                     {problem});
    EXPECT_TRUE(folder.names().empty());
}

TEST(ImageOutputTest, AFolderOfImagesOfAnyKindIsReplacedWithForce) {
    const TemporaryFolder folder;
    for (const ImageFormat format : {ImageFormat::kPng, ImageFormat::kTiff, ImageFormat::kExr})
        write_three(folder / "frames", {.images = {.format = format}, .force = true});
    EXPECT_EQ(read_all(folder / "frames").size(), 3 * kShape.sites());
}

}  // namespace
}  // namespace stipple
