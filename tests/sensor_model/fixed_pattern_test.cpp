#include "sensor_model/fixed_pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/parallel.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 400, .cols = 500, .planes = 1};
constexpr double kSites = 400.0 * 500;

SensorParams physical(const PhysicalTerms& terms) {
    return {.mode = SensorMode::kPhysical, .physical = terms};
}

struct Moments {
    double mean;
    double deviation;
};

Moments moments(const FixedPattern& pattern, const std::function<double(const SiteParams&)>& of) {
    double sum = 0, sum2 = 0;
    for (std::size_t i = 0; i < kShape.pixels(); ++i) {
        const double value = of(pattern.plane(0)[i]);
        sum += value;
        sum2 += value * value;
    }
    const double mean = sum / kSites;
    return {mean, std::sqrt(sum2 / kSites - mean * mean)};
}

// The mean of n deviates scatters by s / sqrt(n), their deviation by s / sqrt(2 n): 5 of either.
constexpr double kMean = 5 / 447.2, kDeviation = 5 / 632.4;

TEST(FixedPatternTest, WithoutTermsIsThePixelOfEquationOne) {
    const FixedPattern pattern(physical({}), kShape);
    for (std::size_t i = 0; i < kShape.pixels(); i += 997) {
        const SiteParams& site = pattern.plane(0)[i];
        EXPECT_EQ(site.responsivity_e, 1000.0F);
        EXPECT_EQ(site.dark_e_per_slot, 0.0F);
        EXPECT_EQ(site.offset_e, 0.0F);
        EXPECT_EQ(site.read_noise_e, 10.0F);
        EXPECT_EQ(site.gain, 1.0F);
    }
}

TEST(FixedPatternTest, HasTheConfiguredSpreads) {
    const FixedPattern pattern(
        physical({.quantum_efficiency = 0.5, .dsnu_e = 3, .prnu = 0.04, .read_noise_spread = 0.2}),
        kShape);
    const auto responsivity = moments(pattern, [](const auto& s) { return s.responsivity_e; });
    EXPECT_NEAR(responsivity.mean, 500, 20 * kMean);
    EXPECT_NEAR(responsivity.deviation, 20, 20 * kDeviation);
    const auto offset = moments(pattern, [](const auto& s) { return s.offset_e; });
    EXPECT_NEAR(offset.mean, 0, 3 * kMean);
    EXPECT_NEAR(offset.deviation, 3, 3 * kDeviation);
    const auto noise2 = moments(
        pattern, [](const auto& s) { return std::pow(static_cast<double>(s.read_noise_e), 2); });
    EXPECT_NEAR(noise2.mean, 100, 100 * 0.4 * kMean) << "read_noise_e is the rms over pixels";
}

TEST(FixedPatternTest, DoublesTheDarkCurrentEveryDoublingInterval) {
    const auto dark = [](double temperature_c) {
        PhysicalTerms terms{.dark_current_e_per_s = 40, .temperature_c = temperature_c};
        return FixedPattern(physical(terms), {1, 1, 1}).plane(0)->dark_e_per_slot;
    };
    EXPECT_FLOAT_EQ(dark(20), 40 * 5e-3F);
    EXPECT_FLOAT_EQ(dark(28), 80 * 5e-3F);
    EXPECT_FLOAT_EQ(dark(-4), 5 * 5e-3F);
    EXPECT_FLOAT_EQ(dark(24), 40 * 5e-3F * std::sqrt(2.0F));
}

TEST(FixedPatternTest, HasTheShareOfHotAndDeadPixels) {
    const FixedPattern pattern(physical({.dark_current_e_per_s = 10,
                                         .dsnu_e = 1,
                                         .hot_pixel_fraction = 0.02,
                                         .hot_pixel_dark_current = 4000,
                                         .dead_pixel_fraction = 0.01}),
                               kShape);
    int hot = 0, dead = 0;
    for (std::size_t i = 0; i < kShape.pixels(); ++i) {
        const SiteParams& site = pattern.plane(0)[i];
        if (site.dark_e_per_slot > 1) {
            ++hot;
            EXPECT_FLOAT_EQ(site.dark_e_per_slot, 4010 * 5e-3F);
        }
        if (site.responsivity_e == 0) {
            ++dead;
            EXPECT_EQ(site.offset_e, 0);
            EXPECT_EQ(site.read_noise_e, 0);
        }
    }
    // Five standard deviations of a binomial count.
    EXPECT_NEAR(hot, 0.02 * kSites, 5 * std::sqrt(0.02 * kSites));
    EXPECT_NEAR(dead, 0.01 * kSites, 5 * std::sqrt(0.01 * kSites));
}

TEST(FixedPatternTest, ColumnsShareTheirOffset) {
    const FixedPattern pattern(physical({.column_noise_e = 5}), kShape);
    double sum2 = 0;
    for (std::size_t col = 0; col < 500; ++col) {
        const float offset = pattern.plane(0)[col].offset_e;
        EXPECT_EQ(pattern.plane(0)[399 * 500 + col].offset_e, offset);
        sum2 += std::pow(static_cast<double>(offset), 2);
    }
    EXPECT_NEAR(std::sqrt(sum2 / 500), 5, 5 * 5 / std::sqrt(1000.0));
}

TEST(FixedPatternTest, RepeatsTheMapsOfTheTile) {
    const FixedPattern pattern(physical({.map_rows = 2,
                                         .map_cols = 3,
                                         .transmittance = {1, 0.5, 0.25, 0.125, 1, 1},
                                         .gain_map = {1, 2, 3, 4, 5, 6}}),
                               kShape);
    for (const int row : {0, 1, 2, 399})
        for (const int col : {0, 1, 2, 3, 499}) {
            const auto& site = pattern.plane(0)[row * 500 + col];
            EXPECT_EQ(site.gain, static_cast<float>(row % 2 * 3 + col % 3 + 1));
            if (row % 2 == 0) {
                EXPECT_EQ(site.responsivity_e, std::ldexp(1000.0F, -(col % 3)));
            }
        }
}

/// Sites of a sensor that has every pattern there is.
std::vector<float> traits_of(std::uint32_t device_id, FrameShape shape) {
    const FixedPattern pattern(physical({.dark_current_e_per_s = 10,
                                         .dsnu_e = 1,
                                         .prnu = 0.01,
                                         .read_noise_spread = 0.1,
                                         .column_noise_e = 1,
                                         .device_id = device_id}),
                               shape);
    std::vector<float> traits;
    for (int plane = 0; plane < shape.planes; ++plane)
        for (std::size_t i = 0; i < shape.pixels(); ++i) {
            const SiteParams& s = pattern.plane(static_cast<std::uint32_t>(plane))[i];
            traits.insert(traits.end(), {s.responsivity_e, s.offset_e, s.read_noise_e});
        }
    return traits;
}

TEST(FixedPatternTest, IsFrozenByTheDeviceAndTheSameForAnyNumberOfThreads) {
    const FrameShape shape{.rows = 40, .cols = 30, .planes = 2};
    const auto chip = traits_of(7, shape);
    const ThreadLimit limit(1);
    EXPECT_EQ(traits_of(7, shape), chip);
    EXPECT_NE(traits_of(8, shape), chip);
    const auto half = static_cast<std::ptrdiff_t>(chip.size() / 2);
    EXPECT_FALSE(std::equal(chip.begin(), chip.begin() + half, chip.begin() + half));
}

}  // namespace
}  // namespace stipple
