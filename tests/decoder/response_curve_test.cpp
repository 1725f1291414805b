#include "decoder/response_curve.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

ResponseTable squares() {
    return {.linear_dn = {0, 1, 4, 9}, .variance_dn2 = {0, 1, 2, 3}};
}

TEST(ResponseCurveTest, HasTheNumbersOfItsTableAndTheirSlopes) {
    const ResponseTable table = squares();
    const ResponseCurve curve(table);
    EXPECT_EQ(curve.linear_dn(2), 4);
    EXPECT_EQ(curve.variance_dn2(3), 3);
    EXPECT_EQ(curve.slope(0), 1);
    EXPECT_EQ(curve.slope(1), 2);
    EXPECT_EQ(curve.slope(2), 4);
    EXPECT_EQ(curve.slope(3), 5);
    EXPECT_EQ(curve.slope_where(4), 4);
    EXPECT_EQ(curve.slope_where(100), 5);
}

TEST(ResponseCurveTest, MeansAreInterpolatedAndDnBeyondTheTableAreItsLast) {
    const ResponseTable table = squares();
    const ResponseCurve curve(table);
    EXPECT_EQ(curve.linear_mean(1.5), 2.5);
    EXPECT_EQ(curve.linear_mean(3), 9);
    EXPECT_EQ(curve.linear_dn(65535), 9);
}

}  // namespace
}  // namespace stipple
