#include <gtest/gtest.h>

#include <algorithm>

#include "scenes/scene.h"
#include "tests/pipeline/clip.h"

namespace stipple {
namespace {

class SceneQualityTest : public testing::TestWithParam<std::string> {
  protected:
    static FluxVideo render() {
        const SceneOptions options{
            .slots = 32, .shape = {.rows = 120, .cols = 160, .planes = 3}, .time_samples = 4};
        const Scene scene(scene_from_name(GetParam()), options);
        FluxVideo video(options.slots, options.shape);
        for (int slot = 0; slot < options.slots; ++slot) scene.render(slot, video.frame(slot));
        return video;
    }
};

TEST_P(SceneQualityTest, FastBeatsConventionalCamerasOfTheSameBandwidth) {
    const FluxVideo video = render();
    const VideoQuality fast = quality_of(video, "random", DecodeMethod::kFast);
    const VideoQuality tiled = quality_of(video, "tiled", DecodeMethod::kFast);
    const VideoQuality naive = quality_of(video, "random", DecodeMethod::kNaive);
    const VideoQuality camera_4x = quality_of(video, "full4x", DecodeMethod::kNaive);
    const VideoQuality camera_1x = quality_of(video, "full1x", DecodeMethod::kNaive);
    RecordProperty("psnr_db", std::to_string(fast.psnr_db));
    RecordProperty("psnr_gamma_db", std::to_string(fast.psnr_gamma_db));
    for (const VideoQuality& other : {naive, camera_4x, camera_1x}) {
        // Where little moves, four short exposures interpolate well, and the linear error of
        // `still` is that of its brightest areas, which only 1 in 15 slots sees unsaturated.
        if (GetParam() != "still") {
            EXPECT_GT(fast.psnr_db, other.psnr_db);
        }
        EXPECT_GT(fast.psnr_gamma_db, other.psnr_gamma_db);
    }
    EXPECT_GE(tiled.psnr_db, fast.psnr_db - 0.5);
    EXPECT_GE(tiled.psnr_gamma_db, fast.psnr_gamma_db - 0.5);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneQualityTest,
                         testing::Values("pan", "roll", "pencils", "dice", "still"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace stipple
