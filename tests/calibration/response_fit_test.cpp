#include "calibration/response_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr DnRange kRange{.black_dn = 64, .bit_depth = 12};
constexpr double kWell = 4000;

/// Samples of a chip that loses the fraction `loss` q / w of a charge of q DN: the sample of
/// docs/physics.md, without noise.
double sample_of(double charge_dn, double loss) {
    return kRange.black_dn + charge_dn * (1 - loss * charge_dn / kWell);
}

/// The inverse.
double charge_of(double dn, double loss) {
    return (1 - std::sqrt(1 - 4 * loss * (dn - kRange.black_dn) / kWell)) * kWell / (2 * loss);
}

/// `count` levels in equal steps up to 0.9 of the well, known to `sigma_dn`.
std::vector<ResponseLevel> levels_of(double loss, int count, double sigma_dn, std::size_t scale = 0,
                                     double brightest = 0.9) {
    std::vector<ResponseLevel> levels;
    std::mt19937 random(static_cast<std::uint32_t>(7 + scale));
    std::normal_distribution<double> normal(0, sigma_dn);
    for (int i = 1; i <= count; ++i) {
        const double charge = brightest * kWell * i / count;
        levels.push_back({.scale = scale,
                          .exposure = charge * (1 + static_cast<double>(scale)),
                          .dark_dn = kRange.black_dn,
                          .mean_dn = sample_of(charge, loss) + normal(random),
                          .variance_dn2 = sigma_dn * sigma_dn});
    }
    return levels;
}

TEST(ResponseFitTest, FindsTheChargeOfEachSample) {
    const double loss = 0.1;
    const ResponseFit fit = fit_response(levels_of(loss, 12, 0.1), kRange, "flats");
    ASSERT_EQ(fit.table.linear_dn.size(), 4096U);
    EXPECT_EQ(fit.levels, 12U);
    double square = 0, count = 0;
    for (std::size_t dn = 64; dn <= 3600; ++dn) {
        const double error = static_cast<double>(fit.table.linear_dn[dn]) - 64 -
                             charge_of(static_cast<double>(dn), loss);
        if (static_cast<double>(dn) > fit.brightest_dn) break;
        EXPECT_LT(std::abs(error), 4) << dn;  // 0.1 % of the well
        const auto variance = static_cast<double>(fit.table.variance_dn2[dn]);
        if (variance > 0) square += error * error / variance;
        ++count;
    }
    // The errors of neighbours are the same error, so their mean square is only near 1.
    EXPECT_LT(square / count, 6);
    EXPECT_NEAR(fit.bend_dn, charge_of(fit.brightest_dn, loss) + 64 - fit.brightest_dn, 4);
}

TEST(ResponseFitTest, ALinearChipHasNoTable) {
    for (std::size_t seed = 0; seed < 20; ++seed) {
        const ResponseFit fit = fit_response(levels_of(0, 10, 0.2, seed), kRange, "flats");
        EXPECT_TRUE(fit.table.linear_dn.empty()) << seed;
        EXPECT_EQ(fit.levels, 10U);
    }
}

// Streams of several lights, each with exposures of several lengths.
TEST(ResponseFitTest, LightsOfUnknownRatioAreJoined) {
    const double loss = 0.08;
    std::vector<ResponseLevel> levels = levels_of(loss, 4, 0.1, 0, 0.9);
    for (const auto& more : {levels_of(loss, 4, 0.1, 1, 0.5), levels_of(loss, 4, 0.1, 2, 0.2)})
        levels.insert(levels.end(), more.begin(), more.end());
    const ResponseFit fit = fit_response(levels, kRange, "flats");
    ASSERT_FALSE(fit.table.linear_dn.empty());
    for (const std::size_t dn : {500U, 1500U, 3000U})
        EXPECT_NEAR(static_cast<double>(fit.table.linear_dn[dn]) - 64,
                    charge_of(static_cast<double>(dn), loss), 6);
}

TEST(ResponseFitTest, TwoLevelsOrLevelsOfUnknownRatiosTellNothing) {
    EXPECT_EQ(fit_response(levels_of(0.1, 2, 0.1), kRange, "flats").levels, 0U);
    std::vector<ResponseLevel> levels = levels_of(0.1, 9, 0.1);
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i].scale = i;
    EXPECT_EQ(fit_response(levels, kRange, "flats").levels, 0U);
}

TEST(ResponseFitTest, NamesSamplesThatFallWhileLightRises) {
    std::vector<ResponseLevel> levels = levels_of(0.1, 6, 0.1);
    levels[4].mean_dn = levels[3].mean_dn - 20;
    const auto message =
        message_of<InputError>([&] { static_cast<void>(fit_response(levels, kRange, "flats")); });
    expect_parts(message, {"flats: falls from ", "tells no response curve"});
}

TEST(ResponseFitTest, GoesOnStraightAboveTheBrightestLevel) {
    const ResponseFit fit = fit_response(levels_of(0.1, 12, 0.1, 0, 0.6), kRange, "flats");
    const auto& f = fit.table.linear_dn;
    const auto from = static_cast<std::size_t>(fit.brightest_dn) + 2;
    const float slope = f[from + 1] - f[from];
    EXPECT_NEAR(f[4095] - f[from], slope * static_cast<float>(4095 - from), 3);
    // The uncertainty grows.
    EXPECT_GT(fit.table.variance_dn2[4095], fit.table.variance_dn2[from]);
    EXPECT_EQ(f[30], 30);  // below the dark level nothing is known
}

}  // namespace
}  // namespace stipple
