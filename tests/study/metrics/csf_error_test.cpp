#include "study/metrics/perceptual.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/error.h"
#include "tests/support/noise.h"

namespace stipple {
namespace {

using Floats = std::vector<float>;

Floats grating(FrameShape shape, int row_cycles, int col_cycles, double amplitude) {
    Floats image;
    for (int row = 0; row < shape.rows; ++row)
        for (int col = 0; col < shape.cols; ++col) {
            const double cycles = static_cast<double>(row_cycles * row) / shape.rows +
                                  static_cast<double>(col_cycles * col) / shape.cols;
            image.push_back(
                static_cast<float>(amplitude * std::cos(2 * std::numbers::pi * cycles)));
        }
    return image;
}

TEST(CsfErrorTest, TakesThePublishedMaximumAndFallsBeyondIt) {
    // Mannos and Sakrison give 8 cycles per degree, and 0.98 of the ordinate there.
    EXPECT_EQ(contrast_sensitivity(0, 0), 1);
    EXPECT_EQ(contrast_sensitivity(7.8, 0), 1);
    EXPECT_NEAR(contrast_sensitivity(8, 0), 1, 1e-3);
    for (double f = 8; f < 60; f += 1)
        EXPECT_GT(contrast_sensitivity(f, 0), contrast_sensitivity(f + 1, 0)) << f;
    const double u = 0.114 * 30;
    EXPECT_NEAR(contrast_sensitivity(30, 0),
                2.6 * (0.0192 + u) * std::exp(-std::pow(u, 1.1)) / 0.9809, 1e-4);
}

TEST(CsfErrorTest, ObliqueGratingsAreSeenAsThoseOf10SeventhsOfTheirFrequency) {
    // cos(4 * 45 degrees) = -1: f is divided by 0.7.
    const double along = 20 / std::numbers::sqrt2;
    EXPECT_NEAR(contrast_sensitivity(along, along), contrast_sensitivity(20 / 0.7, 0), 1e-12);
    EXPECT_NEAR(contrast_sensitivity(-along, along), contrast_sensitivity(along, along), 1e-12);
    EXPECT_NEAR(contrast_sensitivity(0, 20), contrast_sensitivity(20, 0), 1e-12);
}

TEST(CsfErrorTest, AConstantCountsInFull) {
    for (const FrameShape shape : {FrameShape{12, 16, 1}, FrameShape{7, 9, 1}, FrameShape{1, 1, 1}})
        EXPECT_NEAR(CsfError(shape, 60).mean_square(Floats(shape.sites(), 3.0F)), 9, 1e-12);
}

TEST(CsfErrorTest, AGratingIsWeightedByItsFrequency) {
    // Half the square of the amplitude, but that at the Nyquist frequency, whose cosine is +-1.
    for (const FrameShape shape : {FrameShape{24, 32, 1}, FrameShape{15, 21, 1}})
        for (const int row_cycles : {0, 3, 7})
            for (const int col_cycles : {1, 5, 10}) {
                const double weight = contrast_sensitivity(60.0 * col_cycles / shape.cols,
                                                           60.0 * row_cycles / shape.rows);
                const double found =
                    CsfError(shape, 60).mean_square(grating(shape, row_cycles, col_cycles, 2));
                EXPECT_NEAR(found, 2 * weight * weight, 1e-6) << row_cycles << ' ' << col_cycles;
            }
    const double nyquist = contrast_sensitivity(30, 0);
    EXPECT_NEAR(CsfError({8, 8, 1}, 60).mean_square(grating({8, 8, 1}, 0, 4, 2)),
                4 * nyquist * nyquist, 1e-6);
}

TEST(CsfErrorTest, FromFarAwayNoiseIsNotSeenAndFromNearItIsSeenInFull) {
    Floats error = noise(32 * 32, 1);
    double mean = 0;
    for (const float value : error) mean += static_cast<double>(value) / 1024;
    double mean_square = 0;
    for (float& value : error) {
        value -= static_cast<float>(mean);
        mean_square += static_cast<double>(value) * static_cast<double>(value) / 1024;
    }
    const FrameShape shape{32, 32, 1};
    // All frequencies, up to 0.5 / sqrt(0.5) / 0.7 cycles per pixel, are below 7.89 per degree.
    EXPECT_NEAR(CsfError(shape, 5).mean_square(error), mean_square, 1e-6);
    // The lowest is 10000 / 32 cycles per degree.
    EXPECT_LT(CsfError(shape, 10000).mean_square(error), 1e-9 * mean_square);
}

TEST(CsfErrorTest, RefusesADegreeWithoutPixels) {
    EXPECT_THROW(CsfError({8, 8, 1}, 0), InputError);
}

}  // namespace
}  // namespace stipple
