#include "decoder/conventional/zhang2009.h"

#include <gtest/gtest.h>

#include <vector>

namespace stipple {
namespace {

// Two patches m + a and m - a, whose one component has the power 2 |a|^2 = 60.
const std::vector<float> kPair{11, 12, 13, 14, 9, 8, 7, 6};

TEST(PatchStackTest, OnePatchIsItsMean) {
    std::vector<float> stack{1, 2, 3, 4};
    EXPECT_EQ(filter_patch_stack(stack, 1, 100), 1);
    EXPECT_EQ(stack, (std::vector<float>{1, 2, 3, 4}));
}

TEST(PatchStackTest, AComponentIsKeptByItsWienerFactor) {
    std::vector<float> stack = kPair;
    const float factor = (60.0F - 4) / 60;  // the noise has the power sigma^2 times 4 values
    EXPECT_NEAR(filter_patch_stack(stack, 2, 1), 1 + factor * factor, 1e-5F);
    for (std::size_t i = 0; i < stack.size(); ++i)
        EXPECT_NEAR(stack[i], 10 + factor * (kPair[i] - 10), 1e-5F) << i;
}

// Its largest eigenvalue is sigma^2 (sqrt(4) + sqrt(2))^2 = 11.66 sigma^2: 60 for 2.27.
TEST(PatchStackTest, AComponentBelowTheLargestOfNoiseIsNot) {
    std::vector<float> stack = kPair;
    EXPECT_GT(filter_patch_stack(stack, 2, 2.26F), 1);
    stack = kPair;
    EXPECT_EQ(filter_patch_stack(stack, 2, 2.28F), 1);
    for (const float value : stack) EXPECT_NEAR(value, 10, 1e-5F);
}

}  // namespace
}  // namespace stipple
