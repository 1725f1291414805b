#include "calibration/scene_gain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/error.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 40, .cols = 50, .planes = 1};
constexpr int kSlots = 64;
constexpr double kPrnu = 0.06;

/// 1 DN an electron, 1000 electrons a unit of light, no read noise; two exposures in turn, of one
/// slot and of three.
StreamHeader chip() {
    return {.shape = kShape,
            .slot_us = 5000,
            .calibration = {.bit_depth = 16,
                            .black_level_dn = 100,
                            .gain_e_per_dn = 1,
                            .read_noise_e = 0,
                            .full_well_e = 60000,
                            .electrons_per_unit = 1000},
            .schedule = {1, 1, 4, {0, 2}, {{0, 0b1}, {1, 0b111}}},
            .schedule_source = {},
            .schedule_name = "",
            .provenance = ""};
}

float light_at(int slot, std::size_t pixel) {
    return 2 + std::sin(0.3F * static_cast<float>(slot) + 0.01F * static_cast<float>(pixel));
}

/// Samples of a trial.
struct Setup {
    double sample_error = 0;  ///< relative, its standard deviation
    double full_well_e = 60000;
    float brightness = 1;  ///< factor of the light
    /// Light above which a sample is any number.
    double any_above = std::numeric_limits<double>::infinity();
};

/// Gains of the pixels, and their estimate.
struct Trial {
    explicit Trial(const Setup& setup) {
        std::mt19937 random(1), other(2);
        std::normal_distribution<double> normal;
        for (std::size_t i = 0; i < kShape.pixels(); ++i)
            gain.push_back(1 + kPrnu * normal(random));
        StreamHeader header = chip();
        header.calibration.full_well_e = setup.full_well_e;
        SceneGain scene(header, "clip.stipple");
        std::vector<float> frame(kShape.pixels());
        for (int slot = 0; slot < kSlots; ++slot) {
            for (std::size_t i = 0; i < frame.size(); ++i)
                frame[i] = setup.brightness * light_at(slot, i);
            scene.add_frame(frame);
            if (slot % 4 != 0 && slot % 4 != 3) continue;
            SamplePacket packet{.slot = slot, .rows = kShape.rows, .dn = {}};
            for (std::size_t i = 0; i < frame.size(); ++i) {
                double light = static_cast<double>(light_at(slot, i));
                if (slot % 4 == 3)
                    light += static_cast<double>(light_at(slot - 1, i) + light_at(slot - 2, i));
                light *= static_cast<double>(setup.brightness);
                double electrons =
                    1000 * gain[i] * light * (1 + setup.sample_error * normal(random));
                if (light > setup.any_above) electrons = static_cast<double>(other() % 65536);
                electrons = std::min(electrons, setup.full_well_e);
                packet.dn.push_back(
                    static_cast<std::uint16_t>(std::min(std::lround(100 + electrons), 65535L)));
            }
            scene.add_samples(packet);
        }
        estimate = scene.estimate(kPrnu);
    }

    /// Root mean square error of the gains.
    [[nodiscard]] double error() const {
        double sum = 0;
        for (std::size_t i = 0; i < gain.size(); ++i)
            sum += std::pow(static_cast<double>(estimate.sites[i].gain) - gain[i], 2);
        return std::sqrt(sum / static_cast<double>(gain.size()));
    }

    std::vector<double> gain;
    ChipCalibration estimate;
};

TEST(SceneGainTest, FindsTheGainsOfExactSamples) {
    // The least error that is believed, PRNU^2 / 5, shrinks each gain by 1 / 6.
    const Trial trial({});
    EXPECT_NEAR(trial.error(), kPrnu / 6, 0.1 * kPrnu);
    EXPECT_EQ(trial.estimate.shape, kShape);
    EXPECT_FLOAT_EQ(trial.estimate.sites[7].offset_dn, 100);
}

TEST(SceneGainTest, ShrinksGainsByTheScatterThatPrnuLeaves) {
    // 32 samples with errors of 30 %: 5.3 % of the gain, so the best estimate errs by 6 % x 5.3 % /
    // hypot(6 %, 5.3 %) = 4.0 %.
    const Trial trial({.sample_error = 0.3});
    EXPECT_NEAR(trial.error(), 0.040, 0.004);
}

// The range ends at the full well, or where the converter does. Three slots have a light of up
// to 81.
TEST(SceneGainTest, SamplesOfLightAbove80PercentOfTheRangeDoNotCountWhateverTheyAre) {
    for (const double full_well_e : {60000.0, 1e6}) {
        const double used = 0.8 * std::min(full_well_e, 65535.0 - 100) / 1000;
        const auto sites = [&](double any_above) {
            return Trial({.full_well_e = full_well_e, .brightness = 9, .any_above = any_above})
                .estimate.sites;
        };
        EXPECT_EQ(sites(used), sites(100)) << full_well_e;
        EXPECT_NE(sites(0.98 * used), sites(100)) << full_well_e;
    }
}

TEST(SceneGainTest, LeavesPixelsWithoutLightAsTheyAre) {
    const StreamHeader header = chip();
    SceneGain scene(header, "clip.stipple");
    scene.add_frame(std::vector<float>(kShape.pixels()));
    scene.add_samples(
        {.slot = 0, .rows = kShape.rows, .dn = std::vector<std::uint16_t>(kShape.pixels(), 130)});
    const ChipCalibration estimate = scene.estimate(kPrnu);
    EXPECT_EQ(estimate.sites[3].gain, 1);
}

TEST(SceneGainTest, RefusesWeightedExposures) {
    StreamHeader header = chip();
    header.schedule.set_weights({0.5F, 1, 1, 1});
    EXPECT_THROW(SceneGain(header, "clip.stipple"), InputError);
}

}  // namespace
}  // namespace stipple
