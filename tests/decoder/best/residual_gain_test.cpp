#include "decoder/best/collaborative.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "readout/schedules/tiled_schedule.h"
#include "study/scenes/scene.h"
#include "tests/decoder/hand_made.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr float kBright = 1e6F;  ///< much light for its noise

TEST(ResidualGainTest, NothingIsFedBackWhereEachVoxelHasItsOwnSample) {
    EXPECT_EQ(residual_part(1, kBright, 0, 1), 0);
    EXPECT_EQ(residual_part(3, kBright, 0, 1), 0) << "several sensors";
}

TEST(ResidualGainTest, ItFallsBeyondOneSampleForFourVoxels) {
    EXPECT_EQ(residual_part(0.25F, kBright, 0, 1), 1);
    EXPECT_FLOAT_EQ(residual_part(0.5F, kBright, 0, 1), 4.0F / 9);
    EXPECT_FLOAT_EQ(residual_part(0.75F, kBright, 0, 1), 1.0F / 9);
}

TEST(ResidualGainTest, ReadNoiseAloneHalvesWhatShotNoiseAloneGets) {
    EXPECT_EQ(residual_part(0, kBright, 0, 1), 1);
    EXPECT_FLOAT_EQ(residual_part(0, kBright, 1, 1), 0.5F);
    EXPECT_FLOAT_EQ(residual_part(0, kBright, 1, 0), 0.5F) << "no exposure ends here";
    EXPECT_FLOAT_EQ(residual_part(0.25F, kBright, 0.25F, 1), 0.875F);
}

TEST(ResidualGainTest, NoiseAboveTheLightKeepsAllOfIt) {
    EXPECT_EQ(residual_part(0, 0, 1, 1), 1);
    EXPECT_EQ(residual_part(0, 0, 1, 0), 1);
    EXPECT_FLOAT_EQ(residual_part(0, 1, 1, 1), 5.0F / 6);
    EXPECT_FLOAT_EQ(residual_part(0, -1, 1, 1), 5.0F / 6);
}

TEST(ResidualGainTest, CountsTheSamplesOfAllSensors) {
    const FrameShape pair{1, 2, 1};
    Measurements m = hand_made(4, pair, {{0, 0}, {1, 0, 3}});
    EXPECT_EQ(samples_per_voxel(m), 2.0F / 8);
    m.others.push_back(hand_made(4, pair, {{0, 0}, {0, 1}, {0, 2}}));
    EXPECT_EQ(samples_per_voxel(m), 5.0F / 8);
}

/// Light of the scene `pan` up to 2.0.
FluxVideo pan(int slots, FrameShape shape) {
    const Scene scene(SceneName::kPan, {.slots = slots, .shape = shape, .time_samples = 1});
    FluxVideo video(slots, shape);
    for (int slot = 0; slot < slots; ++slot) {
        scene.render(slot, video.frame(slot));
        for (float& light : video.frame(slot)) light = std::min(light, 2.0F);
    }
    return video;
}

/// Mean squared error, without the first and last four slots, of light and of its power 1/2.2.
struct Errors {
    double linear = 0;
    double gamma = 0;
};

Errors errors_of(const FluxVideo& x, const FluxVideo& truth) {
    Errors errors;
    for (int slot = 4; slot < truth.slots() - 4; ++slot)
        for (std::size_t i = 0; i < truth.shape().sites(); ++i) {
            const auto light = [&](const FluxVideo& video) {
                return std::clamp(static_cast<double>(video.frame(slot)[i]), 0.0, 2.0);
            };
            const auto square = [](double error) { return error * error; };
            errors.linear += square(light(x) - light(truth));
            errors.gamma += square(std::pow(light(x), 1 / 2.2) - std::pow(light(truth), 1 / 2.2));
        }
    return errors;
}

Errors errors_of(const FluxVideo& truth, const Recorded& recorded, const DecodeOptions& options) {
    const auto x =
        decode_block(collect_measurements(recorded.header, recorded.packets, whole(truth)),
                     recorded.header.calibration, options);
    return errors_of(*x, truth);
}

double by_db(double error, double other) {
    return 10 * std::log10(other / error);
}

class FullRateTest : public testing::TestWithParam<double> {};

// A sample for each voxel: all that is left is to take its noise out.
TEST_P(FullRateTest, BestIsAboveFastAndNoWorseThanVbm4d) {
    const FluxVideo truth = pan(18, {56, 56, 1});
    const Recorded recorded = record(truth, full_schedule(1, 1), {.photons_per_unit = GetParam()});
    const Errors best = errors_of(truth, recorded, {});
    const Errors fast = errors_of(truth, recorded, {.method = DecodeMethod::kFast});
    const Errors vbm4d = errors_of(truth, recorded, {.method = DecodeMethod::kVbm4d});
    EXPECT_GT(by_db(best.linear, fast.linear), 1);
    EXPECT_GT(by_db(best.gamma, fast.gamma), 1);
    EXPECT_GT(by_db(best.linear, vbm4d.linear), -0.3);
    RecordProperty("over_fast_db", std::to_string(by_db(best.linear, fast.linear)));
    RecordProperty("over_vbm4d_db", std::to_string(by_db(best.linear, vbm4d.linear)));
}

INSTANTIATE_TEST_SUITE_P(Photons, FullRateTest, testing::Values(100, 1000),
                         [](const auto& test) { return std::to_string(std::lround(test.param)); });

// Here most noise is read noise, and detail is hidden in long exposures: half of the gain loses
// detail, twice of it, as without the rule, returns noise.
TEST(ResidualGainTest, InDimLightTheGainLiesBetweenTooLittleAndTooMuch) {
    const FluxVideo truth = pan(24, {48, 48, 1});
    const Recorded recorded =
        record(truth, random_schedule(48, 48, kPaperExposureSlots, 1), {.photons_per_unit = 100});
    const auto error_at = [&](float factor) {
        DecodeOptions options;
        options.best.residual_gain *= factor;
        return errors_of(truth, recorded, options).gamma;
    };
    const double error = error_at(1);
    EXPECT_GT(by_db(error, error_at(0.5F)), 0.05);
    EXPECT_GT(by_db(error, error_at(2)), 0.2);
}

}  // namespace
}  // namespace stipple
