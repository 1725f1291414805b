#include "decoder/conventional/volume_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/index.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

TEST(VolumeTransformTest, TheDctIsThatOfItsFormula) {
    for (int n = 1; n <= kMaxVolumeFrames; ++n) {
        const SquareMatrix dct = dct_matrix(n);
        for (int k = 0; k < n; ++k)
            for (int i = 0; i < n; ++i)
                ASSERT_NEAR(dct.values[row_major(k, i, n)],
                            std::sqrt((k == 0 ? 1.0 : 2.0) / n) *
                                std::cos(std::numbers::pi * k * (2 * i + 1) / (2.0 * n)),
                            1e-7);
    }
}

TEST(VolumeTransformTest, TheHaarTransformOfFour) {
    const auto half = static_cast<float>(std::numbers::sqrt2 / 2);
    const std::vector<float> expected{0.5F, 0.5F,  0.5F, 0.5F, 0.5F, 0.5F, -0.5F, -0.5F,
                                      half, -half, 0,    0,    0,    0,    half,  -half};
    const SquareMatrix haar = haar_matrix(4);
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_FLOAT_EQ(haar.values[i], expected[i]);
}

TEST(VolumeTransformTest, KeepsThePowerAndIsInverted) {
    const VolumeTransform transform;
    for (const int volumes : {1, 2, 8, kMaxGroupVolumes})
        for (const int frames : {1, 3, 9, kMaxVolumeFrames}) {
            const auto group =
                random_values(index(volumes) * index(frames) * kBlockPixels, -1, 1, 1);
            std::vector<float> values = group;
            transform.forward(volumes, frames, values);
            EXPECT_NEAR(dot(values, values) / dot(group, group), 1, 1e-5);
            transform.inverse(volumes, frames, values);
            for (std::size_t i = 0; i < values.size(); ++i) ASSERT_NEAR(values[i], group[i], 2e-6);
        }
}

TEST(VolumeTransformTest, AConstantHasOneCoefficient) {
    std::vector<float> values(4 * 5 * kBlockPixels, 0.5F);
    VolumeTransform().forward(4, 5, values);
    EXPECT_NEAR(values[0], 0.5 * std::sqrt(4.0 * 5 * kBlockPixels), 1e-5);
    for (std::size_t i = 1; i < values.size(); ++i) ASSERT_NEAR(values[i], 0, 1e-6);
}

}  // namespace
}  // namespace stipple
