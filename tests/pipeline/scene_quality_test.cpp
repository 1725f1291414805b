#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "tests/pipeline/clip.h"
#include "tests/support/temporary_folder.h"

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

/// A sensor, its settings, and a factor of its light.
struct SensorCase {
    std::string sensor;
    std::vector<std::string> settings;
    double light = 1;
};

class SensorQualityTest : public testing::TestWithParam<SensorCase> {};

// The decoders hold on any sensor and in any light, not only on the paper's.
TEST_P(SensorQualityTest, FastAndBestAreBetterThanNaive) {
    const auto& [name, settings, light] = GetParam();
    const SensorParams sensor = sensor_of(name, settings, light);
    const SceneOptions options{
        .slots = 28, .shape = {.rows = 48, .cols = 64, .planes = 1}, .time_samples = 2};
    const Scene scene(SceneName::kDice, options);
    FluxVideo video(options.slots, options.shape);
    const auto brightest = static_cast<float>(std::min(2.0, clipping_light(sensor)));
    for (int slot = 0; slot < options.slots; ++slot) {
        scene.render(slot, video.frame(slot));
        for (float& value : video.frame(slot)) value = std::min(value, brightest);
    }
    const TemporaryFolder folder;
    write_recording(video, schedule_of("random", video.shape()), sensor, folder / "a.stipple");
    const auto quality = [&](DecodeMethod method) {
        return quality_of(read_recording(folder / "a.stipple", method), video);
    };
    const VideoQuality naive = quality(DecodeMethod::kNaive);
    const VideoQuality fast = quality(DecodeMethod::kFast);
    const VideoQuality best = quality(DecodeMethod::kBest);
    EXPECT_GT(fast.psnr_db, naive.psnr_db + 0.5);
    EXPECT_GT(fast.psnr_gamma_db, naive.psnr_gamma_db + 0.5);
    EXPECT_GT(best.psnr_db, fast.psnr_db - 0.1);
    EXPECT_GT(best.psnr_gamma_db, fast.psnr_gamma_db - 0.1);
}

std::vector<SensorCase> sensor_cases() {
    std::vector<SensorCase> cases;
    for (const double light : {1.0, 4.0, 0.1}) {
        for (const char* name : {"paper", "lux1310", "grasshopper", "t6"})
            cases.push_back({name, {}, light});
        cases.push_back({"paper", {"bit_depth=10", "full_well_e=1800"}, light});
    }
    return cases;
}

INSTANTIATE_TEST_SUITE_P(Sensors, SensorQualityTest, testing::ValuesIn(sensor_cases()),
                         [](const auto& test) {
                             const SensorCase& it = test.param;
                             const std::string light = std::to_string(std::lround(it.light * 10));
                             return it.sensor + (it.settings.empty() ? "" : "_well") + "_light_" +
                                    light + "_tenths";
                         });

}  // namespace
}  // namespace stipple
