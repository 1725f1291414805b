#include "study/scenes/surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stipple {
namespace {

constexpr int kTexels = 512;

struct Moments {
    double mean = 0;
    double variance = 0;
    double largest = 0;
};

Moments moments(const NoiseTexture& texture) {
    Moments m;
    double squares = 0;
    for (int row = 0; row < kTexels; ++row)
        for (int col = 0; col < kTexels; ++col) {
            const auto value = static_cast<double>(
                texture.at(static_cast<float>(col) / kTexels, static_cast<float>(row) / kTexels));
            m.mean += value / (kTexels * kTexels);
            squares += value * value / (kTexels * kTexels);
            m.largest = std::max(m.largest, std::abs(value));
        }
    m.variance = squares - m.mean * m.mean;
    return m;
}

TEST(NoiseTextureTest, HasZeroMeanUnitVarianceAndLimit) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Moments m = moments(NoiseTexture(kTexels, 0.85F, SceneRandom(seed), 0));
        // The six octaves have variance 0.0765 x 3.09 in units of the first one's amplitude; a
        // tile's mean is that of 16, 64, ... values of variance 1/3, 0.7225/3, ...: it scatters by
        // sqrt(0.0208 x 1.22 / 0.236) = 0.33, and so does the variance within a tile at most.
        EXPECT_NEAR(m.mean, 0, 1.0) << "seed " << seed;
        EXPECT_NEAR(m.variance, 1, 0.5) << "seed " << seed;
        EXPECT_LE(m.largest, static_cast<double>(NoiseTexture::kLimit));
    }
}

TEST(NoiseTextureTest, IsPeriodicAndContinuousAcrossTheSeam) {
    const NoiseTexture texture(kTexels, 0.85F, SceneRandom(1), 0);
    for (int i = 0; i < 64; ++i) {
        const float u = static_cast<float>(i) / 64;
        EXPECT_EQ(texture.at(u, 0.25F), texture.at(u - 3, 2.25F));
        // Neighbouring texels differ by less than the whole range of the finest octave, about 1.
        EXPECT_NEAR(texture.at(u, 0), texture.at(u, -1.0F / kTexels), 1.0F);
    }
}

TEST(NoiseTextureTest, LargerImagesAddDetailToTheSamePattern) {
    const NoiseTexture small(kTexels, 0.55F, SceneRandom(1), 0);
    const NoiseTexture large(2 * kTexels, 0.55F, SceneRandom(1), 0);
    double difference2 = 0;
    for (int row = 0; row < 64; ++row)
        for (int col = 0; col < 64; ++col) {
            const float u = static_cast<float>(col) / 64;
            const float v = static_cast<float>(row) / 64;
            difference2 += static_cast<double>(square(small.at(u, v) - large.at(u, v))) / 4096;
        }
    // One more octave: (1 - p^2) p^12 = 0.0005 of the variance, and a little for the clamping.
    EXPECT_LT(difference2, 0.01);
}

TEST(NoiseTextureTest, SeedsAndLayersDiffer) {
    const NoiseTexture a(kTexels, 0.85F, SceneRandom(1), 0);
    const NoiseTexture b(kTexels, 0.85F, SceneRandom(2), 0);
    const NoiseTexture c(kTexels, 0.85F, SceneRandom(1), 1);
    EXPECT_NE(a.at(0.3F, 0.6F), b.at(0.3F, 0.6F));
    EXPECT_NE(a.at(0.3F, 0.6F), c.at(0.3F, 0.6F));
}

}  // namespace
}  // namespace stipple
