#include "decoder/pixel_transforms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

PlaneTriple triple(std::vector<float>& x) {
    const std::size_t pixels = x.size() / 3;
    return {x.data(), &x[pixels], &x[2 * pixels]};
}

TEST(OpponentPlanesTest, GreyHasLumaOnly) {
    std::vector<float> x{0.5F, 0.5F, 0.5F};
    to_opponents(1, triple(x));
    EXPECT_NEAR(x[0], 0.5 * std::sqrt(3), 1e-6);
    EXPECT_EQ(x[1], 0);
    EXPECT_EQ(x[2], 0);
}

TEST(OpponentPlanesTest, KeepsLengthsAndHasItsTransposeAsInverse) {
    const std::vector<float> rgb = random_values(3 * 37, -1, 2, 1);
    std::vector<float> x = rgb;
    to_opponents(37, triple(x));
    EXPECT_NEAR(dot(x, x), dot(rgb, rgb), 1e-4);
    const std::vector<float> other = random_values(3 * 37, -1, 2, 2);
    std::vector<float> back = other;
    from_opponents(37, triple(back));
    EXPECT_NEAR(dot(x, other), dot(rgb, back), 1e-4);  // <T rgb, other> = <rgb, T^T other>
    from_opponents(37, triple(x));
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], rgb[i], 1e-6);
}

}  // namespace
}  // namespace stipple
