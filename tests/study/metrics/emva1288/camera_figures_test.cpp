#include "study/metrics/emva1288/camera_figures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple::emva1288 {
namespace {

constexpr double kGain = 0.25;  // DN/e
constexpr double kEfficiency = 0.6;
constexpr double kBlack = 100;    // DN
constexpr double kDarkNoise = 8;  // e
constexpr double kDsnu = 2;       // e
constexpr double kPrnu = 0.01;
constexpr double kWell = 10000;  // e

struct Camera {
    Series series{.bits = 12, .cols = 8, .rows = 8, .groups = {}};
    std::vector<GroupStatistics> statistics;

    void add(double photons, std::size_t images) {
        const double e = kEfficiency * photons;
        const bool full = e > kWell;
        const double signal = full ? kWell : e;
        const double noise2 = kDarkNoise * kDarkNoise + (full ? 0 : e);
        const double spread2 = kDsnu * kDsnu + kPrnu * kPrnu * signal * signal;
        series.groups.push_back({.exposure_ns = 1000,
                                 .photons = photons,
                                 .dark = photons == 0,
                                 .files = std::vector<std::string>(images, "a.png")});
        statistics.push_back({.count = images,
                              .images = {.mean_dn = kBlack + kGain * signal,
                                         .temporal_variance_dn2 = kGain * kGain * noise2 + 1.0 / 12,
                                         .spatial_variance_dn2 = kGain * kGain * spread2},
                              .zero_fraction = 0});
    }
};

/// A linear camera without chance, its series in the wrong order.
Camera linear_camera() {
    Camera camera;
    for (int i = 50; i >= 1; --i) camera.add(1.15 * kWell / kEfficiency * i / 50, 2);
    camera.add(0, 2);
    camera.add(0, 100);
    camera.add(0.5 * kWell / kEfficiency, 100);
    return camera;
}

TEST(CameraFiguresTest, OfALinearCameraAreItsOwn) {
    const Camera camera = linear_camera();
    const Evaluation found = evaluate(camera.series, camera.statistics, "a");
    const CameraFigures& f = found.figures;
    EXPECT_NEAR(f.gain_dn_per_e, kGain, 1e-12);
    EXPECT_NEAR(f.quantum_efficiency, kEfficiency, 1e-12);
    EXPECT_NEAR(f.dark_noise_e, kDarkNoise, 1e-12);
    EXPECT_NEAR(f.dsnu_e, kDsnu, 1e-12);
    EXPECT_NEAR(f.prnu, kPrnu, 1e-12);
    EXPECT_NEAR(f.linearity_error, 0, 1e-12);
    // The last step below the full well: 43 x 2.3 %.
    EXPECT_NEAR(f.saturation_e, 43 * 0.023 * kWell, 1e-6);
    EXPECT_NEAR(f.snr_max, std::sqrt(f.saturation_e), 1e-9);
    // The threshold solves SNR = eta mu / sqrt(sigma_d^2 + sigma_q^2 / K^2 + eta mu) = 1.
    const double e = kEfficiency * f.sensitivity_threshold_p;
    EXPECT_NEAR(e / std::sqrt(64 + 16.0 / 12 + e), 1, 1e-12);
    EXPECT_NEAR(f.dynamic_range, f.saturation_e / e, 1e-6);
    EXPECT_EQ(found.transfer.size(), 50U);
    EXPECT_EQ(found.saturation, 42U);
    EXPECT_DOUBLE_EQ(found.dark_mean_dn, kBlack);
}

/// Relative non-uniformities of the light, and those of the dark in electrons, in parts.
struct Patterns {
    double row, column, pixel, high_pass;
};

// What the dark has of a part is no response to light: of each part PRNU is without its DSNU.
TEST(CameraFiguresTest, EachPartOfThePrnuIsWithoutItsPartOfTheDsnu) {
    constexpr Patterns kDark{.row = 3, .column = 5, .pixel = 7, .high_pass = 9};
    constexpr Patterns kLight{.row = 0.002, .column = 0.003, .pixel = 0.008, .high_pass = 0.009};
    Camera camera = linear_camera();
    for (GroupStatistics& group : camera.statistics) {
        const double signal = (group.images.mean_dn - kBlack) / kGain;
        const auto variance_dn2 = [&](double Patterns::*part) {
            return kGain * kGain * (std::pow(kDark.*part, 2) + std::pow(kLight.*part * signal, 2));
        };
        group.split = {.row_dn2 = variance_dn2(&Patterns::row),
                       .column_dn2 = variance_dn2(&Patterns::column),
                       .pixel_dn2 = variance_dn2(&Patterns::pixel)};
        group.high_pass_dn2 = variance_dn2(&Patterns::high_pass);
    }
    const CameraFigures f = evaluate(camera.series, camera.statistics, "a").figures;
    EXPECT_NEAR(f.dsnu_row_e, kDark.row, 1e-12);
    EXPECT_NEAR(f.dsnu_column_e, kDark.column, 1e-12);
    EXPECT_NEAR(f.dsnu_pixel_e, kDark.pixel, 1e-12);
    EXPECT_NEAR(f.dsnu_high_pass_e, kDark.high_pass, 1e-12);
    EXPECT_NEAR(f.prnu_row, kLight.row, 1e-12);
    EXPECT_NEAR(f.prnu_column, kLight.column, 1e-12);
    EXPECT_NEAR(f.prnu_pixel, kLight.pixel, 1e-12);
    EXPECT_NEAR(f.prnu_high_pass, kLight.high_pass, 1e-12);
}

// The errors of the variances may leave less in the light than in the dark.
TEST(CameraFiguresTest, ThereIsNoPrnuOfAPartThatTheLightDoesNotIncrease) {
    Camera camera = linear_camera();
    for (GroupStatistics& group : camera.statistics) {
        group.split.row_dn2 = group.images.mean_dn > kBlack ? 1 : 2;
        group.split.column_dn2 = -1;
    }
    const CameraFigures f = evaluate(camera.series, camera.statistics, "a").figures;
    EXPECT_EQ(f.prnu_row, 0);
    EXPECT_EQ(f.prnu_column, 0);
    EXPECT_EQ(f.dsnu_column_e, 0);
    EXPECT_NEAR(f.dsnu_row_e, std::sqrt(2) / kGain, 1e-12);
}

TEST(CameraFiguresTest, LinearityErrorIsTheMeanDistanceToTheBestLine) {
    Camera camera = linear_camera();
    for (std::size_t i = 0; i < 50; ++i)  // 1 % up and down by turns
        camera.statistics[i].images.mean_dn +=
            (i % 2 == 0 ? 0.01 : -0.01) * (camera.statistics[i].images.mean_dn - kBlack);
    EXPECT_NEAR(evaluate(camera.series, camera.statistics, "a").figures.linearity_error, 0.01,
                5e-4);
}

TEST(CameraFiguresTest, LinearityErrorTakesTwoPointsBetween5And95PercentOfSaturation) {
    Camera camera;
    for (int i = 1; i <= 9; ++i) camera.add(0.005 * i * kWell / kEfficiency, 2);
    camera.add(kWell / kEfficiency, 2);
    camera.add(0, 2);
    camera.add(0, 100);
    camera.add(0.5 * kWell / kEfficiency, 100);
    const auto error = [&] {
        return evaluate(camera.series, camera.statistics, "a").figures.linearity_error;
    };
    EXPECT_TRUE(std::isnan(error()));
    camera.add(0.2 * kWell / kEfficiency, 2);
    EXPECT_TRUE(std::isnan(error()));
    camera.add(0.7 * kWell / kEfficiency, 2);
    EXPECT_NEAR(error(), 0, 1e-12);
}

TEST(CameraFiguresTest, SaysWhatTheSeriesLacks) {
    const auto refuse = [](const Camera& camera, const std::vector<std::string>& parts) {
        expect_parts(message_of<InputError>(
                         [&] { return evaluate(camera.series, camera.statistics, "a.txt"); }),
                     parts);
    };
    Camera camera = linear_camera();
    camera.series.groups.back().files.resize(2);
    refuse(camera, {"a.txt", "no stack of more than two bright images"});
    camera = linear_camera();
    camera.series.groups[51].files.resize(2);
    refuse(camera, {"no stack of more than two dark images"});
    camera = linear_camera();
    camera.series.groups[7].exposure_ns = 2000;
    refuse(camera, {"no pair of dark images of 2000 ns"});
    camera = linear_camera();
    camera.series.groups.erase(camera.series.groups.begin(), camera.series.groups.begin() + 45);
    camera.statistics.erase(camera.statistics.begin(), camera.statistics.begin() + 45);
    refuse(camera, {"has 5 pairs of bright images"});
    camera = linear_camera();
    for (auto& group : camera.statistics) group.images.temporal_variance_dn2 = 1;
    refuse(camera, {"more light does not give more noise"});
    camera = linear_camera();
    for (std::size_t i = 10; i < 50; ++i) camera.statistics[i].images.temporal_variance_dn2 = 1;
    camera.statistics[49].images.temporal_variance_dn2 = 9000;
    refuse(camera, {"below 70 % of saturation"});
}

}  // namespace
}  // namespace stipple::emva1288
