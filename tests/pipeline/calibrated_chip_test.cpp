#include <gtest/gtest.h>

#include "calibration/scene_gain.h"
#include "decoder/decode_options.h"
#include "stream/stream_reader.h"
#include "study/scenes/scene.h"
#include "tests/pipeline/chip_sites.h"
#include "tests/pipeline/clip.h"
#include "tests/support/footage_folder.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

FluxVideo render() {
    const SceneOptions options{
        .slots = 20, .shape = {.rows = 64, .cols = 64, .planes = 3}, .time_samples = 2};
    const Scene scene(scene_from_name("pan"), options);
    FluxVideo video(options.slots, options.shape);
    for (int slot = 0; slot < options.slots; ++slot) scene.render(slot, video.frame(slot));
    return video;
}

double psnr(const FluxVideo& video, const SensorParams& sensor, std::vector<SiteCalibration> sites,
            ResponseTable response = {}) {
    const TemporaryFolder folder;
    write_recording(video, schedule_of("random", video.shape()), sensor, folder / "clip.stipple");
    const FluxVideo decoded = read_recording(folder / "clip.stipple", DecodeMethod::kFast,
                                             std::move(sites), std::move(response));
    return quality_of(decoded, video).psnr_gamma_db;
}

// In much light, where the fixed pattern is the largest noise.
TEST(CalibratedChipTest, AHundredFlatsUndoTheFixedPattern) {
    const FluxVideo video = render();
    const SensorParams sensor =
        sensor_of("t6", {"dsnu_e=60", "column_noise_e=30", "black_level_dn=128"}, 4);
    const ChipEstimate estimate =
        calibrated_chip(sensor, video.shape(), {.darks = 100, .flats = 100});
    const double equal = psnr(video, without_fixed_pattern(sensor), {});
    const double uncalibrated = psnr(video, sensor, {});
    const double calibrated = psnr(video, sensor, estimate.calibration.sites);
    RecordProperty("equal_db", std::to_string(equal));
    RecordProperty("uncalibrated_db", std::to_string(uncalibrated));
    RecordProperty("calibrated_db", std::to_string(calibrated));
    EXPECT_GT(calibrated, equal - 0.3);
    EXPECT_LT(uncalibrated, equal - 0.6);
}

// Bright, so that the response bends by up to its 10 %.
TEST(CalibratedChipTest, LevelsOfLightUndoANonLinearResponse) {
    const FluxVideo video = render();
    const SensorParams sensor = sensor_of("t6", {"response_loss=0.1"}, 4);
    const ChipEstimate estimate =
        calibrated_chip(sensor, video.shape(), {.darks = 50, .flats = 50, .levels = 12});
    const ChipEstimate linear = calibrated_chip(sensor, video.shape(), {.darks = 50, .flats = 50});
    const double equal = psnr(video, without_fixed_pattern(sensor), {});
    const double straight = psnr(video, sensor, linear.calibration.sites);
    const double calibrated =
        psnr(video, sensor, estimate.calibration.sites, estimate.calibration.response);
    RecordProperty("equal_db", std::to_string(equal));
    RecordProperty("straight_db", std::to_string(straight));
    RecordProperty("calibrated_db", std::to_string(calibrated));
    EXPECT_GT(calibrated, equal - 0.3);
    EXPECT_LT(straight, equal - 0.6);
}

TEST(CalibratedChipTest, FootageItselfGainsBackHalfOfWhatUnequalGainsCost) {
    const auto video = luminance_clip("mouse250_a");
    if (!video) GTEST_SKIP() << "no footage mouse250_a in " << footage_folder();
    const SensorParams sensor = sensor_of("t6");
    const TemporaryFolder folder;
    const auto file = folder / "clip.stipple";
    write_recording(*video, schedule_of("random", video->shape()), sensor, file);
    StreamReader decoded(file), samples(file);
    const auto chip = scene_calibration(decoded, samples, DecodeOptions{}, sensor.physical.prnu);
    ASSERT_TRUE(chip.has_value());
    const double equal = psnr(*video, without_fixed_pattern(sensor), {});
    const double uncalibrated = psnr(*video, sensor, {});
    const double calibrated = psnr(*video, sensor, chip->sites);
    RecordProperty("equal_db", std::to_string(equal));
    RecordProperty("uncalibrated_db", std::to_string(uncalibrated));
    RecordProperty("calibrated_db", std::to_string(calibrated));
    EXPECT_GT(calibrated, (equal + uncalibrated) / 2);
    EXPECT_LT(uncalibrated, equal - 0.5);
}

}  // namespace
}  // namespace stipple
