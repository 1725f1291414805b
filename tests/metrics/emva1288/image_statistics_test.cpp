#include "metrics/emva1288/image_statistics.h"

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

TEST(ImageStatisticsTest, OfIdenticalImagesHaveNoNoise) {
    const Image image{0, 65535, 65535, 3};
    const ImageStatistics found = statistics({image, image, image});
    EXPECT_NEAR(found.temporal_variance_dn2, 0, 1e-5);
}

}  // namespace
}  // namespace stipple::emva1288
