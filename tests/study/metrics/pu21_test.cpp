#include "study/metrics/perceptual.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

TEST(Pu21Test, TakesThePublishedValuesAtTheEndsAndAt100) {
    // The authors scale the curve so that it begins with 0, has 256 at 100 cd/m2 (given as a whole
    // number) and for banding_glare ends with 595.39.
    EXPECT_NEAR(pu21(0.005), 0, 1e-6);
    EXPECT_NEAR(pu21(100), 256, 0.5);
    EXPECT_NEAR(pu21(10000), 595.39, 0.005);
}

TEST(Pu21Test, RisesEverywhere) {
    for (double luminance = 0.005; luminance < 9000; luminance *= 1.1)
        EXPECT_LT(pu21(luminance), pu21(luminance * 1.1)) << luminance;
}

TEST(Pu21Test, ClampsLuminanceOutsideItsRange) {
    EXPECT_EQ(pu21(-1), pu21(0.005));
    EXPECT_EQ(pu21(1e6), pu21(10000));
}

}  // namespace
}  // namespace stipple
