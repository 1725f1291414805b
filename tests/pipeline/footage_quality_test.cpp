// Real footage through the paper's sensor and back. The least quality of `fast` is that of the
// motion-compensated total variation measured before this decoder was written, on the same clips
// with the same noise, less 0.2 dB; that of `best` is that of the collaborative filter
// measured then (docs/notes/decoder_experiments.md).
#include <gtest/gtest.h>

#include <iterator>

#include "tests/pipeline/clip.h"
#include "tests/support/footage_folder.h"

namespace stipple {
namespace {

struct ClipQuality {
    std::string name;
    double psnr_db;
    double psnr_gamma_db;
};

void PrintTo(const ClipQuality& clip, std::ostream* stream) {
    *stream << clip.name;
}

class FootageQualityTest : public testing::TestWithParam<ClipQuality> {};
class BestOnFootageTest : public FootageQualityTest {};

/// What `method` makes of the clip's random samples: at least as good as `least`, and better than
/// conventional cameras of the same bandwidth.
VideoQuality expect_quality(const FluxVideo& video, DecodeMethod method, const ClipQuality& least) {
    const VideoQuality coded = quality_of(video, "random", method);
    testing::Test::RecordProperty("psnr_db", std::to_string(coded.psnr_db));
    testing::Test::RecordProperty("psnr_gamma_db", std::to_string(coded.psnr_gamma_db));
    EXPECT_GE(coded.psnr_db, least.psnr_db);
    EXPECT_GE(coded.psnr_gamma_db, least.psnr_gamma_db);
    for (const std::string conventional : {"full4x", "full1x"}) {
        const VideoQuality camera = quality_of(video, conventional, DecodeMethod::kNaive);
        EXPECT_GT(coded.psnr_db, camera.psnr_db) << conventional;
        EXPECT_GT(coded.psnr_gamma_db, camera.psnr_gamma_db) << conventional;
        EXPECT_GT(coded.pu21_psnr_db, camera.pu21_psnr_db) << conventional;
    }
    return coded;
}

TEST_P(FootageQualityTest, FastIsAsGoodAsThePrototypeAndBetterThanConventionalCameras) {
    const auto video = luminance_clip(GetParam().name);
    if (!video) GTEST_SKIP() << "no footage " << GetParam().name << " in " << footage_folder();
    const VideoQuality random = expect_quality(*video, DecodeMethod::kFast, GetParam());
    const VideoQuality tiled = quality_of(*video, "tiled", DecodeMethod::kFast);
    EXPECT_GE(tiled.psnr_db, random.psnr_db - 0.5);
    EXPECT_GE(tiled.psnr_gamma_db, random.psnr_gamma_db - 0.5);
}

TEST_P(BestOnFootageTest, BestIsAsGoodAsTheFilterOfBeforeAndBetterThanConventionalCameras) {
    const auto video = luminance_clip(GetParam().name);
    if (!video) GTEST_SKIP() << "no footage " << GetParam().name << " in " << footage_folder();
    expect_quality(*video, DecodeMethod::kBest, GetParam());
}

class ConventionalFootageTest : public testing::Test {
  protected:
    /// By how much `best` is better than frames of four slots held, which is what the camera gives:
    /// the mean over the first 32 slots of the middles of the clips, linear and after 1/2.2, where
    /// dark light counts more and blur less.
    static void expect_gain(int side, double min_db, double min_gamma_db) {
        double gain_db = 0;
        double gain_gamma_db = 0;
        constexpr const char* kClips[] = {"mouse250_a",   "mouse250_b", "nat30_blocks",
                                          "nat30_coffee", "hdr_desk",   "hdr_desk_fg",
                                          "hdr_stilllife"};
        for (const char* name : kClips) {
            const auto video = luminance_clip(name);
            if (!video) GTEST_SKIP() << "no footage " << name << " in " << footage_folder();
            const FluxVideo part = middle(*video, side, 32);
            const VideoQuality held = quality_of(part, "full4x", DecodeMethod::kNaive);
            const VideoQuality best = quality_of(part, "full4x", DecodeMethod::kBest);
            gain_db += (best.psnr_db - held.psnr_db) / std::size(kClips);
            gain_gamma_db += (best.psnr_gamma_db - held.psnr_gamma_db) / std::size(kClips);
        }
        EXPECT_GE(gain_db, min_db);
        EXPECT_GE(gain_gamma_db, min_gamma_db);
    }
};

TEST_F(ConventionalFootageTest, BestOnFramesOfFourSlotsIsBetterThanHoldingThem) {
    expect_gain(256, 0.6, 0.9);
}

TEST_F(ConventionalFootageTest, MoreSoInTheMiddle) {
    expect_gain(128, 1, 1);
}

// One clip of each kind: a camera of 250 fps, one of 30, one that moves over an HDR photograph. All
// seven: bench_decode.
INSTANTIATE_TEST_SUITE_P(Clips, BestOnFootageTest,
                         testing::Values(ClipQuality{"mouse250_a", 35.7, 35.3},
                                         ClipQuality{"nat30_coffee", 31.3, 32.3},
                                         ClipQuality{"hdr_desk", 33.9, 32.1}),
                         [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(Clips, FootageQualityTest,
                         testing::Values(ClipQuality{"mouse250_a", 32.51, 32.18},
                                         ClipQuality{"mouse250_b", 31.12, 31.23},
                                         ClipQuality{"nat30_blocks", 31.94, 30.31},
                                         ClipQuality{"nat30_coffee", 28.71, 29.55},
                                         ClipQuality{"hdr_desk", 31.65, 28.56},
                                         ClipQuality{"hdr_desk_fg", 31.43, 28.12},
                                         ClipQuality{"hdr_stilllife", 29.35, 28.28}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace stipple
