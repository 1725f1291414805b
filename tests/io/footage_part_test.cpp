#include "io/footage_part.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/error.h"
#include "tests/io/npy_bytes.h"
#include "tests/io/test_images.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Floats = std::vector<float>;

/// Light 100 plane + 10 row + col.
Floats numbered(FrameShape shape) {
    Floats light;
    for (int plane = 0; plane < shape.planes; ++plane)
        for (int row = 0; row < shape.rows; ++row)
            for (int col = 0; col < shape.cols; ++col)
                light.push_back(static_cast<float>(100 * plane + 10 * row + col));
    return light;
}

Floats reduced(const FootagePart& part, FrameShape source,
               ColourFilter mosaic = ColourFilter::kNone) {
    FrameReduction reduction(part, source, mosaic, "clip");
    Floats light(reduction.shape().sites());
    reduction(numbered(source), light);
    return light;
}

std::string refusal(const FootagePart& part, FrameShape source,
                    ColourFilter mosaic = ColourFilter::kNone) {
    return message_of<InputError>([&] { FrameReduction(part, source, mosaic, "clip"); });
}

TEST(FootagePartTest, RangesAndAreasAreThoseOfTheirTexts) {
    for (const char* text : {"0:", "3:", "0:5", "3:5"})
        EXPECT_EQ(text_of(parse_frame_range(text)), text);
    EXPECT_EQ(parse_frame_range(":5"), (FrameRange{0, 5}));
    EXPECT_EQ(parse_frame_range(":"), FrameRange());
    for (const char* text : {"640x480", "640x480+16+0"})
        EXPECT_EQ(text_of(parse_crop_area(text)), text);
    EXPECT_EQ(parse_crop_area("6x4+2+1"), (CropArea{4, 6, CropArea::Corner{1, 2}}));
    for (const char* text : {"", "3", "a:b", "-1:3", "3:3", "4:2", "1:2:3", "1.5:3", "1: 3"})
        EXPECT_THROW((void)parse_frame_range(text), InputError) << text;
    for (const char* text : {"", "6", "6x", "x4", "0x4", "6x4+1", "6x4+1+", "6x4+1+2+3", "6x4-1-2",
                             "6x4x2", "6x4+-1+2", "6 x 4", "99999999999x4"})
        EXPECT_THROW((void)parse_crop_area(text), InputError) << text;
}

TEST(FootagePartTest, ACropHasTheNamedPixelsOrThoseOfTheMiddle) {
    constexpr FrameShape kColour{4, 6, 3};
    EXPECT_EQ(reduced({.crop = parse_crop_area("2x1+3+2")}, kColour),
              (Floats{23, 24, 123, 124, 223, 224}));
    EXPECT_EQ(reduced({.crop = parse_crop_area("2x2")}, {4, 6, 1}), (Floats{12, 13, 22, 23}));
    EXPECT_EQ(reduced({.crop = parse_crop_area("6x4+0+0")}, {4, 6, 1}), numbered({4, 6, 1}));
}

TEST(FootagePartTest, AFrameIsCroppedThenBinnedThenResized) {
    FootagePart part{.crop = parse_crop_area("8x4+1+1"), .bin = 2, .size = FrameShape{1, 2}};
    // The mean of rows 1..4 and of columns 1..4 and 5..8.
    EXPECT_EQ(reduced(part, {6, 9, 1}), (Floats{27.5, 31.5}));
    part.size.reset();
    EXPECT_EQ(reduced(part, {6, 9, 1}), (Floats{16.5, 18.5, 20.5, 22.5, 36.5, 38.5, 40.5, 42.5}));
}

TEST(FootagePartTest, WhatDoesNotFitIsRefused) {
    constexpr FrameShape kShape{4, 6, 1};
    expect_parts(refusal({.crop = parse_crop_area("4x2+3+0")}, kShape),
                 {"clip: has 6 x 4 pixels, in which crop = 4x2+3+0 does not lie"});
    expect_parts(refusal({.crop = parse_crop_area("7x4")}, kShape), {"crop = 7x4 does not lie"});
    expect_parts(refusal({.bin = 4}, kShape),
                 {"clip: has 6 x 4 pixels, not a multiple of bin = 4; add crop = 4x4"});
    expect_parts(refusal({.bin = 2, .size = FrameShape{2, 4}}, kShape),
                 {"has 3 x 2 pixels, which resize = 4x2 would enlarge"});
}

TEST(FootagePartTest, TheColoursOfAMosaicStayApart) {
    constexpr FrameShape kShape{6, 10, 1};
    const ColourFilter mosaic = ColourFilter::kRggb;
    expect_parts(refusal({.bin = 2}, kShape, mosaic), {"mosaic", "bin would mix"});
    expect_parts(refusal({.size = FrameShape{3, 5}}, kShape, mosaic), {"resize would mix"});
    expect_parts(refusal({.crop = parse_crop_area("2x2+1+0")}, kShape, mosaic), {"even column"});
    // The middle begins at column 3; the even one before it is taken.
    EXPECT_EQ(reduced({.crop = parse_crop_area("4x2")}, kShape, mosaic),
              (Floats{22, 23, 24, 25, 32, 33, 34, 35}));
}

class FootageFramesTest : public testing::Test {
  protected:
    void SetUp() override {
        Floats light;
        for (const float value : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F})
            light.insert(light.end(), 2, value);
        write_text(folder_ / "clip.npy", npy_file("<f4", "(6, 1, 2)", bytes_of(light)));
    }
    [[nodiscard]] Floats read(const std::string& frames) const {
        Floats light;
        FootageReader reader(folder_ / "clip.npy", of(frames));
        Floats frame(reader.shape().sites());
        while (reader.read(frame)) light.push_back(frame[0]);
        EXPECT_EQ(reader.slots(), light.size());
        return light;
    }
    static FootageOptions of(const std::string& frames) {
        FootageOptions options;
        options.part.frames = parse_frame_range(frames);
        return options;
    }
    const TemporaryFolder folder_;
};

TEST_F(FootageFramesTest, FramesAToBAreRead) {
    EXPECT_EQ(read("2:4"), (Floats{3, 4}));
    EXPECT_EQ(read(":2"), (Floats{1, 2}));
    EXPECT_EQ(read("4:"), (Floats{5, 6}));
    EXPECT_EQ(read(":"), (Floats{1, 2, 3, 4, 5, 6}));
    for (const char* frames : {"6:", "2:7"})
        expect_parts(message_of<InputError>([&] { return read(frames); }),
                     {"clip.npy: has 6 frames, so not all of frames"});
}

TEST_F(FootageFramesTest, LeftOutFramesCountFromTheFirstOfTheRange) {
    FootageReader reader(folder_ / "clip.npy", of("1:5"));
    Floats frame(2);
    reader.skip(1);
    ASSERT_TRUE(reader.read(frame));
    EXPECT_EQ(frame[0], 3);
    reader.skip(1);
    ASSERT_TRUE(reader.read(frame));
    EXPECT_EQ(frame[0], 5);
    EXPECT_FALSE(reader.read(frame));
}

TEST_F(FootageFramesTest, LightIsClippedLast) {
    FootageOptions options = of("0:1");
    write_text(folder_ / "clip.npy", npy_file("<f4", "(1, 2, 2)", bytes_of(Floats{0, 0, 0, 8})));
    options.part.bin = 2;
    options.max_value = 1.5;
    EXPECT_EQ(read_all(folder_ / "clip.npy", options), Floats{1.5});
    options.scale = 0.5;
    EXPECT_EQ(read_all(folder_ / "clip.npy", options), Floats{1});
}

}  // namespace
}  // namespace stipple
