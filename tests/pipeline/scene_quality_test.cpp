#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "study/scenes/scene.h"
#include "tests/pipeline/clip.h"
#include "tests/support/expect_quality.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

class SceneQualityTest : public testing::TestWithParam<ClipFigures> {
  protected:
    static FluxVideo render() {
        const SceneOptions options{
            .slots = 32, .shape = {.rows = 120, .cols = 160, .planes = 3}, .time_samples = 4};
        const Scene scene(scene_from_name(GetParam().name), options);
        FluxVideo video(options.slots, options.shape);
        for (int slot = 0; slot < options.slots; ++slot) scene.render(slot, video.frame(slot));
        return video;
    }
};

TEST_P(SceneQualityTest, FastIsAsGoodAsMeasuredAndBetterThanConventionalCameras) {
    const FluxVideo video = render();
    const VideoQuality fast = quality_of(video, "random", DecodeMethod::kFast);
    const VideoQuality tiled = quality_of(video, "tiled", DecodeMethod::kFast);
    const VideoQuality naive = quality_of(video, "random", DecodeMethod::kNaive);
    const VideoQuality camera_4x = quality_of(video, "full4x", DecodeMethod::kNaive);
    const VideoQuality camera_1x = quality_of(video, "full1x", DecodeMethod::kNaive);
    expect_quality("random", fast, GetParam().random);
    expect_quality("tiled", tiled, GetParam().tiled);
    EXPECT_GE(tiled.psnr_db, fast.psnr_db - 0.5);
    EXPECT_GE(tiled.psnr_gamma_db, fast.psnr_gamma_db - 0.5);
    for (const VideoQuality& other : {naive, camera_4x, camera_1x}) {
        // Where little moves, four short exposures interpolate well, and the linear error of
        // `still` is that of its brightest areas, which only 1 in 15 slots sees unsaturated.
        if (GetParam().name != "still") {
            EXPECT_GT(fast.psnr_db, other.psnr_db);
        }
        EXPECT_GT(fast.psnr_gamma_db, other.psnr_gamma_db);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneQualityTest,
                         testing::ValuesIn(std::vector<ClipFigures>{
                             // `random`: linear, 1/2.2, PU21; `tiled`: the same
                             {"pan", {29.04, 31.01, 29.92}, {29.19, 31.02, 29.95}},
                             {"roll", {30.11, 30.79, 30.48}, {29.86, 30.65, 30.36}},
                             {"pencils", {20.17, 22.75, 22.82}, {20.18, 22.76, 22.82}},
                             {"dice", {24.57, 28.38, 28.02}, {24.40, 28.13, 27.79}},
                             {"still", {30.21, 34.85, 34.11}, {30.09, 34.78, 34.04}}}),
                         [](const auto& test) { return test.param.name; });

/// A sensor, a factor of its light, and what was measured with it.
struct SensorCase {
    std::string sensor;  ///< "well": `paper` with 10 bits and a full well below full scale
    double light;
    MeasuredQuality fast;
    MeasuredQuality best;
};

SensorParams sensor_in(const SensorCase& it) {
    if (it.sensor == "well")
        return sensor_of("paper", {"bit_depth=10", "full_well_e=1800"}, it.light);
    return sensor_of(it.sensor, {}, it.light);
}

class SensorQualityTest : public testing::TestWithParam<SensorCase> {};

// The decoders hold on any sensor and in any light, not only on the paper's.
TEST_P(SensorQualityTest, FastAndBestAreAsGoodAsMeasuredAndBetterThanNaive) {
    const SensorParams sensor = sensor_in(GetParam());
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
    expect_quality("fast", fast, GetParam().fast);
    expect_quality("best", best, GetParam().best);
    EXPECT_GT(fast.psnr_db, naive.psnr_db + 0.5);
    EXPECT_GT(fast.psnr_gamma_db, naive.psnr_gamma_db + 0.5);
    EXPECT_GT(best.psnr_db, fast.psnr_db - 0.1);
    EXPECT_GT(best.psnr_gamma_db, fast.psnr_gamma_db - 0.1);
}

INSTANTIATE_TEST_SUITE_P(Sensors, SensorQualityTest,
                         testing::ValuesIn(std::vector<SensorCase>{
                             // light, `fast`: linear, 1/2.2, PU21; `best`: the same
                             {"paper", 1, {23.66, 26.82, 27.75}, {25.17, 28.00, 28.85}},
                             {"lux1310", 1, {27.26, 28.98, 29.00}, {27.88, 29.69, 29.93}},
                             {"grasshopper", 1, {27.24, 28.89, 28.88}, {27.86, 29.62, 29.79}},
                             {"t6", 1, {25.43, 26.97, 26.67}, {25.80, 26.93, 26.28}},
                             {"well", 1, {22.46, 26.21, 27.22}, {23.65, 27.31, 28.14}},
                             {"paper", 4, {24.95, 25.80, 26.42}, {25.10, 26.00, 26.66}},
                             {"lux1310", 4, {24.62, 27.75, 28.63}, {26.09, 28.95, 29.77}},
                             {"grasshopper", 4, {25.81, 28.56, 29.09}, {27.18, 29.65, 30.22}},
                             {"t6", 4, {25.08, 27.68, 28.00}, {25.97, 28.46, 28.76}},
                             {"well", 4, {25.67, 26.13, 26.55}, {25.76, 26.24, 26.69}},
                             {"paper", 0.1, {23.40, 24.50, 23.83}, {25.12, 25.84, 25.18}},
                             {"lux1310", 0.1, {23.45, 24.67, 24.12}, {25.15, 25.79, 25.10}},
                             {"grasshopper", 0.1, {23.27, 24.58, 24.13}, {24.99, 25.48, 24.65}},
                             {"t6", 0.1, {15.73, 16.89, 16.12}, {20.49, 19.57, 17.69}},
                             {"well", 0.1, {23.45, 24.69, 24.14}, {25.17, 25.79, 25.08}}}),
                         [](const auto& test) {
                             const SensorCase& it = test.param;
                             return it.sensor + "_light_" +
                                    std::to_string(std::lround(it.light * 10)) + "_tenths";
                         });

}  // namespace
}  // namespace stipple
