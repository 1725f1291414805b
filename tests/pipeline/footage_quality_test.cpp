// Real footage through the paper's sensor and back, with the figures that this test measured
// (docs/notes/decoder_experiments.md).
#include <gtest/gtest.h>

#include <iterator>

#include "tests/pipeline/clip.h"
#include "tests/support/expect_quality.h"
#include "tests/support/footage_folder.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr const char* kClips[] = {"mouse250_a", "mouse250_b",  "nat30_blocks", "nat30_coffee",
                                  "hdr_desk",   "hdr_desk_fg", "hdr_stilllife"};

class FootageQualityTest : public testing::TestWithParam<ClipFigures> {};
class BestOnFootageTest : public FootageQualityTest {};

/// Conventional cameras of the same bandwidth: frames of 4 slots, or of 1 in 4.
void expect_better_than_cameras(const VideoQuality& coded, const FluxVideo& video) {
    for (const std::string conventional : {"full4x", "full1x"}) {
        const VideoQuality camera = quality_of(video, conventional, DecodeMethod::kNaive);
        EXPECT_GT(coded.psnr_db, camera.psnr_db) << conventional;
        EXPECT_GT(coded.psnr_gamma_db, camera.psnr_gamma_db) << conventional;
        EXPECT_GT(coded.pu21_psnr_db, camera.pu21_psnr_db) << conventional;
    }
}

TEST_P(FootageQualityTest, FastIsAsGoodAsMeasuredAndBetterThanConventionalCameras) {
    const auto video = luminance_clip(GetParam().name);
    if (!video) GTEST_SKIP() << "no footage " << GetParam().name << " in " << footage_folder();
    const VideoQuality random = quality_of(*video, "random", DecodeMethod::kFast);
    expect_quality("random", random, GetParam().random);
    expect_better_than_cameras(random, *video);
    expect_quality("tiled", quality_of(*video, "tiled", DecodeMethod::kFast), GetParam().tiled);
}

TEST_P(BestOnFootageTest, BestIsAsGoodAsMeasuredAndBetterThanConventionalCameras) {
    const auto video = luminance_clip(GetParam().name);
    if (!video) GTEST_SKIP() << "no footage " << GetParam().name << " in " << footage_folder();
    const VideoQuality random = quality_of(*video, "random", DecodeMethod::kBest);
    expect_quality("random", random, GetParam().random);
    expect_better_than_cameras(random, *video);
}

TEST(LiveOnFootageTest, LiveIsBetterThanNaiveOnEachClip) {
    double linear_db = 0;
    double gamma_db = 0;
    for (const char* name : kClips) {
        const auto video = luminance_clip(name);
        if (!video) GTEST_SKIP() << "no footage " << name << " in " << footage_folder();
        const VideoQuality naive = quality_of(*video, "random", DecodeMethod::kNaive);
        const VideoQuality live = quality_of(*video, "random", DecodeMethod::kLive);
        EXPECT_GT(live.psnr_db, naive.psnr_db + 1) << name;
        EXPECT_GT(live.psnr_gamma_db, naive.psnr_gamma_db + 2) << name;
        linear_db += (live.psnr_db - naive.psnr_db) / std::size(kClips);
        gamma_db += (live.psnr_gamma_db - naive.psnr_gamma_db) / std::size(kClips);
    }
    expect_quality("linear", linear_db, 3.65);
    expect_quality("gamma", gamma_db, 4.08);
}

/// By how much one method is better than another, dB: linear, and after 1/2.2, where dark light
/// counts more and blur less.
struct Gain {
    double linear_db = 0;
    double gamma_db = 0;
};

// Means over the middle 128 x 128 pixels and the first 32 slots of the clips.
TEST(LearnedFootageTest, LearnedIsBetterThanWhatItRefines) {
    const TemporaryFolder folder;
    Gain best, fast;
    for (const char* name : kClips) {
        const auto video = luminance_clip(name);
        if (!video) GTEST_SKIP() << "no footage " << name << " in " << footage_folder();
        const FluxVideo truth = middle(*video, 128, 32);
        write_recording(truth, "random", folder / name);
        const auto add_gain = [&](Gain& gain, DecodeMethod refined, DecodeMethod refines) {
            const VideoQuality after = quality_of(read_recording(folder / name, refined), truth);
            const VideoQuality before = quality_of(read_recording(folder / name, refines), truth);
            gain.linear_db += (after.psnr_db - before.psnr_db) / std::size(kClips);
            gain.gamma_db += (after.psnr_gamma_db - before.psnr_gamma_db) / std::size(kClips);
        };
        add_gain(best, DecodeMethod::kLearned, DecodeMethod::kBest);
        add_gain(fast, DecodeMethod::kLearnedFast, DecodeMethod::kFast);
    }
    EXPECT_GE(best.linear_db, 0.41);  // found: 0.43
    EXPECT_GE(best.gamma_db, 0.44);   // found: 0.46
    EXPECT_GE(fast.linear_db, 0.78);  // found: 0.80
    EXPECT_GE(fast.gamma_db, 1.13);   // found: 1.16
}

// Over frames of four slots held, which is what the camera gives. Means over the first 32 slots of
// the middles of the clips.
TEST(ConventionalFootageTest, BestOnFramesOfFourSlotsIsBetterThanHoldingThemMostInTheMiddle) {
    constexpr int kSlots = 32;
    constexpr int kSides[] = {256, 128};
    Gain gains[std::size(kSides)];
    const TemporaryFolder folder;
    for (const char* name : kClips) {
        const auto video = luminance_clip(name);
        if (!video) GTEST_SKIP() << "no footage " << name << " in " << footage_folder();
        const FluxVideo truth = middle(*video, kSides[0], kSlots);
        write_recording(truth, "full4x", folder / name);
        const FluxVideo held = read_recording(folder / name, DecodeMethod::kNaive);
        const FluxVideo best = read_recording(folder / name, DecodeMethod::kBest);
        for (std::size_t i = 0; i < std::size(kSides); ++i) {
            const auto quality = [&](const FluxVideo& decoded) {
                return quality_of(middle(decoded, kSides[i], kSlots),
                                  middle(truth, kSides[i], kSlots));
            };
            const VideoQuality of_best = quality(best);
            const VideoQuality of_held = quality(held);
            gains[i].linear_db += (of_best.psnr_db - of_held.psnr_db) / std::size(kClips);
            gains[i].gamma_db +=
                (of_best.psnr_gamma_db - of_held.psnr_gamma_db) / std::size(kClips);
        }
    }
    EXPECT_GE(gains[0].linear_db, 0.6);   // found: 0.68
    EXPECT_GE(gains[0].gamma_db, 0.9);    // found: 0.96
    EXPECT_GE(gains[1].linear_db, 1.03);  // found: 1.13
    EXPECT_GE(gains[1].gamma_db, 1.17);   // found: 1.27
}

// One clip of each kind: a camera of 250 fps, one of 30, one that moves over an HDR photograph. All
// seven: bench_decode.
INSTANTIATE_TEST_SUITE_P(Clips, BestOnFootageTest,
                         testing::ValuesIn(std::vector<ClipFigures>{
                             // linear, 1/2.2, PU21
                             {"mouse250_a", {37.17, 36.72, 36.08}},
                             {"nat30_coffee", {33.28, 34.43, 33.64}},
                             {"hdr_desk", {37.18, 35.01, 32.49}}}),
                         [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(Clips, FootageQualityTest,
                         testing::ValuesIn(std::vector<ClipFigures>{
                             // `random`: linear, 1/2.2, PU21; `tiled`: the same
                             {"mouse250_a", {33.39, 33.12, 32.60}, {33.48, 33.18, 32.64}},
                             {"mouse250_b", {32.10, 32.21, 31.84}, {32.13, 32.25, 31.91}},
                             {"nat30_blocks", {34.49, 31.78, 29.45}, {34.44, 31.74, 29.41}},
                             {"nat30_coffee", {29.66, 30.72, 30.03}, {29.65, 30.73, 30.03}},
                             {"hdr_desk", {34.80, 31.42, 29.44}, {34.86, 31.46, 29.46}},
                             {"hdr_desk_fg", {33.88, 30.60, 28.54}, {33.83, 30.63, 28.60}},
                             {"hdr_stilllife", {31.88, 31.72, 30.22}, {32.31, 31.82, 30.35}}}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace stipple
