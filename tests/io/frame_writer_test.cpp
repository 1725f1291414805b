#include "io/frame_writer.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "core/error.h"
#include "io/npy_file.h"
#include "tests/io/test_images.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;
using Floats = std::vector<float>;
using Names = std::vector<std::string>;

constexpr FrameShape kShape{3, 5, 3};

Floats ramp(float start) {
    Floats frame(kShape.sites());
    for (std::size_t i = 0; i < frame.size(); ++i) frame[i] = start + 0.1F * static_cast<float>(i);
    return frame;
}

/// Two frames, ramps from 0 and from 100.
Floats write_two(const fs::path& output, FrameWriterOptions options = {}) {
    FrameWriter writer(output, kShape, options);
    Floats all;
    for (const float start : {0.0F, 100.0F}) {
        const Floats frame = ramp(start);
        writer.write(frame);
        all.insert(all.end(), frame.begin(), frame.end());
    }
    writer.finish();
    return all;
}

TEST(FrameWriterTest, NpyAndExrFoldersKeepEveryBit) {
    const TemporaryFolder folder;
    for (const char* name : {"clip.npy", "frames", "slash/", "v1.5/"}) {
        const Floats written = write_two(folder / name);
        EXPECT_EQ(read_all(folder / name), written) << name;
    }
    EXPECT_EQ(folder.names(), (Names{"clip.npy", "frames", "slash", "v1.5"}));
    EXPECT_TRUE(fs::exists(folder / "frames/frame_0001.exr"));
}

TEST(FrameWriterTest, FramesOfALiveFolderAppearThereOneByOneAndStay) {
    const TemporaryFolder folder;
    const auto output = folder / "frames";
    {
        FrameWriter writer(output, kShape, {.live = true});
        EXPECT_TRUE(fs::is_empty(output));
        writer.write(ramp(0));
        EXPECT_EQ(read_all(output), ramp(0));
        writer.write(ramp(1));  // and no finish()
    }
    EXPECT_EQ(folder.names(), Names{"frames"});
    EXPECT_EQ(std::distance(fs::directory_iterator(output), {}), 2);
    const Floats again = write_two(output, {.force = true, .live = true});
    EXPECT_EQ(read_all(output), again);
    const Floats npy = write_two(folder / "clip.npy", {.live = true});
    EXPECT_EQ(read_all(folder / "clip.npy"), npy);
}

TEST(FrameWriterTest, WritesMonoNpyOfThreeDimensions) {
    const TemporaryFolder folder;
    FrameWriter writer(folder / "clip.npy", {2, 2, 1});
    writer.write(Floats{1, 2, 3, 4});
    writer.finish();
    EXPECT_EQ(read_all(folder / "clip.npy"), (Floats{1, 2, 3, 4}));
    EXPECT_NE(read_text(folder / "clip.npy").find("'shape': (1, 2, 2), }"), std::string::npos);
}

TEST(FrameWriterTest, ANpyFileWhoseWriterWasKilledSaysHowManyFramesItHolds) {
    const TemporaryFolder folder;
    NpyWriter writer(folder / "clip.npy", "clip.npy", {2, 2, 1});
    for (int slots = 1; slots <= 8; ++slots) {
        writer.write(Floats{1, 2, 3, 4});
        if (std::popcount(static_cast<unsigned>(slots)) != 1) continue;
        const std::string file = read_text(folder / "clip.npy");
        const auto header =
            parse_npy_header(std::as_bytes(std::span(file)), file.size(), "clip.npy");
        EXPECT_EQ(header.slots, slots);
    }
}

TEST(FrameWriterTest, LeavesNothingBehindWithoutFinish) {
    const TemporaryFolder folder;
    for (const char* name : {"clip.npy", "frames", "clip.mp4", "clip.mkv", "clip.tif"}) {
        FrameWriter writer(folder / name, kShape);
        writer.write(ramp(0));
        EXPECT_FALSE(fs::exists(folder / name));
        EXPECT_EQ(folder.names().size(), 1U);
    }
    EXPECT_EQ(folder.names(), Names{});
}

TEST(FrameWriterTest, CompletesAnOutputWithoutFrames) {
    const TemporaryFolder folder;
    for (const char* name : {"clip.npy", "frames", "clip.mp4", "clip.mkv", "clip.tif"}) {
        FrameWriter writer(folder / name, kShape);
        writer.finish();
        writer.finish();
        EXPECT_TRUE(fs::exists(folder / name)) << name;
    }
}

TEST(FrameWriterTest, ReplacesAnExistingOutputOnlyWithForce) {
    const TemporaryFolder folder;
    for (const char* name : {"clip.npy", "clip.tif", "frames", "clip.mp4"}) {
        write_two(folder / name);
        expect_parts(message_of<InputError>([&] { write_two(folder / name); }),
                     {"exists already", "force = true"});
        write_two(folder / name, {.force = true});
    }
    EXPECT_EQ(folder.names(), (Names{"clip.mp4", "clip.npy", "clip.tif", "frames"}));
}

TEST(FrameWriterTest, HdrVideoIsForContainersThatDeclareIt) {
    const TemporaryFolder folder;
    FrameWriterOptions options;
    options.video.curve = VideoCurve::kPq;
    for (const char* name : {"clip.y4m", "clip.npy", "clip.tif", "frames"})
        expect_parts(message_of<InputError>([&] { write_two(folder / name, options); }),
                     {name, "holds no HDR video"});
}

TEST(FrameWriterTest, NeverReplacesAFolderWithOtherFiles) {
    const TemporaryFolder folder;
    write_text(folder / "diary.txt", "dear diary");
    expect_parts(message_of<InputError>([&] { write_two(folder.path(), {.force = true}); }),
                 {"diary.txt"});
}

TEST(FrameWriterTest, RefusesUnknownFormats) {
    const TemporaryFolder folder;
    for (const char* name : {"clip.avi", "clip.exr", "clip.png", "clip.v2"})
        expect_parts(message_of<InputError>([&] { write_two(folder / name); }),
                     {std::string(name) + ": videos cannot be written as", ".npy"});
}

TEST(FrameWriterTest, RefusesAMissingFolderBadShapesAndBadRates) {
    const TemporaryFolder folder;
    EXPECT_THROW(write_two(folder / "no/clip.npy"), InputError);
    EXPECT_THROW(FrameWriter(folder / "clip.npy", {0, 5, 1}), InputError);
    EXPECT_THROW(FrameWriter(folder / "clip.npy", {5, 5, 2}), InputError);
    for (const double rate : {0.0, -1.0, 1e9, std::nan("")})
        EXPECT_THROW(FrameWriter(folder / "c.mp4", kShape, {.video = {.frames_hz = rate}}),
                     InputError);
    EXPECT_EQ(folder.names(), Names{});
}

}  // namespace
}  // namespace stipple
