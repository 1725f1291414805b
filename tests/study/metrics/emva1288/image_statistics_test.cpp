#include "study/metrics/emva1288/image_statistics.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace stipple::emva1288 {
namespace {

using Image = std::vector<std::uint16_t>;

ImageStatistics statistics(const std::vector<Image>& images) {
    ImageStack stack;
    for (const Image& image : images) stack.add(image);
    return stack.statistics();
}

TEST(ImageStatisticsTest, OfAPairAreThoseOfTheStandard) {
    const Image a{10, 12, 20, 30}, b{14, 12, 17, 33};
    // Means 18 and 19. Temporal: sum (a - b)^2 / (2 N) - (18 - 19)^2 / 2 = 34 / 8 - 1 / 2.
    const ImageStatistics found = statistics({a, b});
    EXPECT_DOUBLE_EQ(found.mean_dn, 18.5);
    EXPECT_DOUBLE_EQ(found.temporal_variance_dn2, 34.0 / 8 - 0.5);
    // Mean image 12, 12, 18.5, 31.5: variance (6.5^2 + 6.5^2 + 0 + 13^2) / 3.
    EXPECT_DOUBLE_EQ(found.spatial_variance_dn2,
                     (2 * 6.5 * 6.5 + 13 * 13) / 3 - found.temporal_variance_dn2 / 2);
}

TEST(ImageStatisticsTest, TellNoiseFromPatternInAStack) {
    // 2^14 pixels, 40 images: pattern uniform over 0..29 (variance 899 / 12), noise uniform over
    // 0..9 (variance 99 / 12), and a lamp that is 5 DN brighter in every second image.
    std::mt19937 random(1);
    Image pattern(1U << 14U);
    for (auto& value : pattern) value = static_cast<std::uint16_t>(random() % 30);
    ImageStack stack;
    for (unsigned i = 0; i < 40; ++i) {
        Image image = pattern;
        for (auto& value : image)
            value = static_cast<std::uint16_t>(60000 + value + random() % 10 + i % 2 * 5);
        stack.add(image);
    }
    const ImageStatistics found = stack.statistics();
    // The variance of n uniform values scatters by sqrt(0.8 / n) of itself; 5 of that.
    EXPECT_NEAR(found.temporal_variance_dn2 / (99.0 / 12), 1, 5 * 0.0011);
    EXPECT_NEAR(found.spatial_variance_dn2 / (899.0 / 12), 1, 5 * 0.0070);
}

TEST(ImageStatisticsTest, SplitsAPatternIntoRowsColumnsAndPixels) {
    // 200 rows of 300 columns, 20 images; each part uniform over n values: variance (n^2 - 1) / 12.
    constexpr std::size_t kRows = 200, kCols = 300;
    std::mt19937 random(1);
    std::vector<unsigned> rows(kRows), columns(kCols);
    for (unsigned& value : rows) value = static_cast<unsigned>(random() % 20);
    for (unsigned& value : columns) value = static_cast<unsigned>(random() % 10);
    Image pattern(kRows * kCols);
    for (std::size_t i = 0; i < pattern.size(); ++i)
        pattern[i] =
            static_cast<std::uint16_t>(rows[i / kCols] + columns[i % kCols] + random() % 6);
    ImageStack stack;
    for (int i = 0; i < 20; ++i) {
        Image image = pattern;
        for (auto& value : image) value = static_cast<std::uint16_t>(value + random() % 30);
        stack.add(image);
    }
    const SpatialVariances found = stack.spatial_variances(kCols);
    // The variance of n uniform values scatters by sqrt(0.8 / n) of itself; 4 of that.
    EXPECT_NEAR(found.row_dn2 / (399.0 / 12), 1, 4 * 0.063);
    EXPECT_NEAR(found.column_dn2 / (99.0 / 12), 1, 4 * 0.052);
    // The standard divides by M - 1 and by M N - 1: rows and columns lower the part of the pixels.
    const double pixel = 35.0 / 12 - found.row_dn2 / kRows - found.column_dn2 / kCols;
    EXPECT_NEAR(found.pixel_dn2 / pixel, 1, 4 * 0.012);
    const double total = stack.statistics().spatial_variance_dn2;
    EXPECT_NEAR(found.row_dn2 + found.column_dn2 + found.pixel_dn2, total, 0.01 * total);
}

TEST(ImageStatisticsTest, SplitsByTheEquationsOfTheStandard) {
    // Without temporal noise, of M = 3 rows and N = 4 columns, solved by hand.
    const Image image{1, 2, 3, 4, 2, 3, 4, 5, 6, 7, 8, 9};  // 2.5, 3.5, 7.5 and 1, 2, 3, 4
    ImageStack stack;
    for (int i = 0; i < 3; ++i) stack.add(image);
    const SpatialVariances found = stack.spatial_variances(4);
    const double r = 7, c = 5.0 / 3, s2 = (56 + 15) / 11.0;
    EXPECT_NEAR(found.pixel_dn2, 12.0 / 5 * (s2 - r - c), 1e-9);
    EXPECT_NEAR(found.row_dn2, (12 - 4) / 5.0 * r - 3.0 / 5 * (s2 - c), 1e-9);
    EXPECT_NEAR(found.column_dn2, (12 - 3) / 5.0 * c - 4.0 / 5 * (s2 - r), 1e-9);
}

TEST(ImageStatisticsTest, OfIdenticalImagesHaveNoNoise) {
    const Image image{0, 65535, 65535, 3};
    const ImageStatistics found = statistics({image, image, image});
    EXPECT_NEAR(found.temporal_variance_dn2, 0, 1e-5);
}

}  // namespace
}  // namespace stipple::emva1288
