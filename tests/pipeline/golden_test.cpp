// The bits of a decoded clip, which no compiler, SIMD target or number of threads may change. After
// a change of the method on purpose: STIPPLE_UPDATE_GOLDEN=1 build/release/pipeline_test
// --gtest_filter='Golden*'
#include <gtest/gtest.h>

#include <bit>
#include <fstream>

#include "tests/pipeline/clip.h"
#include "tests/support/fnv1a.h"
#include "tests/support/golden_file.h"
#include "tests/support/source_tree.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

/// Coloured discs over a chequered wall, dark to saturated, exact in every arithmetic.
FluxVideo discs(FrameShape shape) {
    FluxVideo video(26, shape);
    for (int slot = 0; slot < video.slots(); ++slot)
        for (int plane = 0; plane < shape.planes; ++plane)
            for (int row = 0; row < shape.rows; ++row)
                for (int col = 0; col < shape.cols; ++col) {
                    const int x = col - 12 - slot;
                    const int y = row - 20;
                    const int wall = (row / 6 + col / 6 + plane) % 3;
                    const int disc = (x / 4 + y / 4 + 40) % 4 + plane;
                    video.plane(slot, plane)(row, col) =
                        static_cast<float>(x * x + y * y < 120 ? 8 + 10 * disc : 1 + 3 * wall) / 32;
                }
    return video;
}

std::uint64_t hash_of(std::span<const float> values) {
    Fnv1a hash;
    for (const float value : values) hash.add(std::bit_cast<std::uint32_t>(value), 4);
    return hash.hash();
}

void expect_golden(const std::string& name, const std::filesystem::path& stream,
                   DecodeMethod method) {
    const FluxVideo decoded = read_recording(stream, method);
    const std::string golden_file =
        (project_path("tests/golden/decoder") / (name + ".fnv1a")).string();
    if (updating_golden())
        std::ofstream(golden_file) << std::hex << hash_of(decoded.data()) << '\n';
    std::uint64_t golden = 0;
    std::ifstream(golden_file) >> std::hex >> golden;
    EXPECT_EQ(hash_of(decoded.data()), golden) << std::hex << hash_of(decoded.data());
}

void expect_golden(const std::string& name, FrameShape shape, DecodeMethod method) {
    const TemporaryFolder folder;
    write_recording(discs(shape), "tiled", folder / "clip.stipple");
    expect_golden(name, folder / "clip.stipple", method);
}

constexpr FrameShape kMono{.rows = 45, .cols = 83, .planes = 1};
constexpr FrameShape kColour{.rows = 40, .cols = 56, .planes = 3};
constexpr FrameShape kSmall{.rows = 20, .cols = 24, .planes = 1};

TEST(GoldenDecodeTest, NaiveKeepsItsBits) {
    expect_golden("naive_mono", kMono, DecodeMethod::kNaive);
    expect_golden("naive_colour", kColour, DecodeMethod::kNaive);
}

TEST(GoldenDecodeTest, FastKeepsItsBits) {
    expect_golden("fast_mono", kMono, DecodeMethod::kFast);
    expect_golden("fast_colour", kColour, DecodeMethod::kFast);
}

TEST(GoldenDecodeTest, AMosaicKeepsItsBits) {
    const TemporaryFolder folder;
    write_mosaic(discs(kColour), ColourFilter::kGbrg, schedule_of("tiled", kColour),
                 folder / "clip.stipple");
    expect_golden("naive_mosaic", folder / "clip.stipple", DecodeMethod::kNaive);
    expect_golden("fast_mosaic", folder / "clip.stipple", DecodeMethod::kFast);
    expect_golden("best_mosaic", folder / "clip.stipple", DecodeMethod::kBest);
}

TEST(GoldenDecodeTest, BestKeepsItsBits) {
    expect_golden("best_mono", kMono, DecodeMethod::kBest);
    expect_golden("best_colour", kColour, DecodeMethod::kBest);
}

TEST(GoldenDecodeTest, LearnedKeepsItsBits) {
    expect_golden("learned_mono", kMono, DecodeMethod::kLearned);
    expect_golden("learned_fast_colour", kColour, DecodeMethod::kLearnedFast);
}

TEST(GoldenDecodeTest, Portz2013KeepsItsBits) {
    expect_golden("portz2013_mono", kSmall, DecodeMethod::kPortz2013);
}

}  // namespace
}  // namespace stipple
