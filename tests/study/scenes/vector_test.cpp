#include "study/scenes/vector.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stipple {
namespace {

constexpr double kTwoPi = 6.283185307179586;

TEST(VectorTest, DirectionIsCosineAndSineForAnyNumberOfTurns) {
    for (double turns = -3; turns < 1000; turns += 0.37) {
        const Vec2 d = direction(turns);
        // 1e-7: the series' error plus rounding to float.
        EXPECT_NEAR(static_cast<double>(d.x), std::cos(kTwoPi * turns), 1e-7) << turns;
        EXPECT_NEAR(static_cast<double>(d.y), std::sin(kTwoPi * turns), 1e-7) << turns;
    }
}

TEST(VectorTest, TurnsOfUndoesDirection) {
    for (double turns = -0.495; turns < 0.5; turns += 0.01) {
        const Vec2 scaled = 3 * direction(turns);
        EXPECT_NEAR(static_cast<double>(turns_of(scaled)), turns, 1e-5);
    }
    EXPECT_EQ(turns_of({0, 0}), 0.0F);
}

TEST(VectorTest, FractionAndWrapAreNeverNegative) {
    EXPECT_EQ(floor_int(-0.25F), -1);
    EXPECT_EQ(floor_int(-2.0F), -2);
    EXPECT_EQ(fraction(-0.25F), 0.75F);
    EXPECT_EQ(wrapped(-1.5, 8), 6.5);
}

TEST(VectorTest, RotationIsUndoneByItsInverse) {
    const Rotation quarter{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
    const Vec3 turned = quarter.apply({1, 2, 3});
    EXPECT_EQ(turned.x, -2.0F);
    EXPECT_EQ(turned.y, 1.0F);
    const Vec3 back = quarter.apply_inverse(turned);
    EXPECT_EQ(back.x, 1.0F);
    EXPECT_EQ(back.y, 2.0F);
    EXPECT_EQ(back.z, 3.0F);
}

}  // namespace
}  // namespace stipple
