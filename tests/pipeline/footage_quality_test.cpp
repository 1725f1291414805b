// Real footage through the paper's sensor and back. The least quality of `fast` is that of the
// motion-compensated total variation measured before this decoder was written, on the same clips
// with the same noise, less 0.2 dB (docs/decoder_experiments.md).
#include <gtest/gtest.h>

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

TEST_P(FootageQualityTest, FastIsAsGoodAsThePrototypeAndBetterThanConventionalCameras) {
    const auto video = luminance_clip(GetParam().name);
    if (!video) GTEST_SKIP() << "no footage " << GetParam().name << " in " << footage_folder();
    const VideoQuality fast = quality_of(*video, "random", DecodeMethod::kFast);
    RecordProperty("psnr_db", std::to_string(fast.psnr_db));
    RecordProperty("psnr_gamma_db", std::to_string(fast.psnr_gamma_db));
    EXPECT_GE(fast.psnr_db, GetParam().psnr_db - 0.2);
    EXPECT_GE(fast.psnr_gamma_db, GetParam().psnr_gamma_db - 0.2);
    for (const std::string conventional : {"full4x", "full1x"}) {
        const VideoQuality camera = quality_of(*video, conventional, DecodeMethod::kNaive);
        EXPECT_GT(fast.psnr_db, camera.psnr_db) << conventional;
        EXPECT_GT(fast.psnr_gamma_db, camera.psnr_gamma_db) << conventional;
    }
    const VideoQuality tiled = quality_of(*video, "tiled", DecodeMethod::kFast);
    EXPECT_GE(tiled.psnr_db, fast.psnr_db - 0.5);
    EXPECT_GE(tiled.psnr_gamma_db, fast.psnr_gamma_db - 0.5);
}

INSTANTIATE_TEST_SUITE_P(Clips, FootageQualityTest,
                         testing::Values(ClipQuality{"mouse250_a", 32.71, 32.38},
                                         ClipQuality{"mouse250_b", 31.32, 31.43},
                                         ClipQuality{"nat30_blocks", 32.14, 30.51},
                                         ClipQuality{"nat30_coffee", 28.91, 29.75},
                                         ClipQuality{"hdr_desk", 31.85, 28.76},
                                         ClipQuality{"hdr_desk_fg", 31.63, 28.32},
                                         ClipQuality{"hdr_stilllife", 29.55, 28.48}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace stipple
