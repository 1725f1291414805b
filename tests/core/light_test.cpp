#include "core/light.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"

namespace stipple {
namespace {

double light_of(double value, Transfer transfer) {
    std::vector<float> values{static_cast<float>(value)};
    linearise(values, transfer);
    return static_cast<double>(values[0]);
}

TEST(LightTest, EachTransferFunctionHasAName) {
    for (const Transfer transfer :
         {Transfer::kLinear, Transfer::kGamma22, Transfer::kSrgb, Transfer::kBt709, Transfer::kPq,
          Transfer::kHlg, Transfer::kAuto}) {
        EXPECT_NE(name_of(transfer), "");
        EXPECT_EQ(value_in(kTransfers, name_of(transfer), "--transfer"), transfer);
    }
    EXPECT_THROW(static_cast<void>(value_in(kTransfers, "rec709", "--transfer")), InputError);
}

TEST(LightTest, FollowsTheFormulasOfTheStandards) {
    constexpr double kFloat = 1e-6;  // relative error of a power in float
    EXPECT_EQ(light_of(0.3, Transfer::kLinear), static_cast<double>(0.3F));
    EXPECT_NEAR(light_of(0.5, Transfer::kGamma22), std::pow(0.5, 2.2), kFloat);
    EXPECT_NEAR(light_of(0.5, Transfer::kSrgb), std::pow(0.555 / 1.055, 2.4), kFloat);
    EXPECT_NEAR(light_of(0.04, Transfer::kSrgb), 0.04 / 12.92, kFloat);
    EXPECT_NEAR(light_of(0.5, Transfer::kBt709), std::pow(0.599 / 1.099, 1 / 0.45), 1e-4);
    EXPECT_NEAR(light_of(0.045, Transfer::kBt709), 0.01, kFloat);
}

// BT.2408-4, table 1: diffuse white of 203 cd/m2 has the signal 58 % in PQ and 75 % in HLG.
TEST(LightTest, DiffuseWhiteOfHdrVideoIsLight1) {
    EXPECT_NEAR(light_of(0.5807, Transfer::kPq), 1, 1e-3);
    EXPECT_NEAR(light_of(0.75, Transfer::kHlg), 1, 2e-3);
}

TEST(LightTest, ValuesBelow0AreLeft) {
    for (const Transfer transfer :
         {Transfer::kGamma22, Transfer::kBt709, Transfer::kPq, Transfer::kHlg})
        EXPECT_EQ(light_of(-0.25, transfer), -0.25);
}

TEST(LightTest, ShapesBeyondTheLimitsAreRefused) {
    EXPECT_EQ(checked_shape(2, 3, 1, "a"), (FrameShape{2, 3, 1}));
    EXPECT_EQ(checked_shape(kMaxFrameSide, 1, 3, "a").rows, kMaxFrameSide);
    EXPECT_THROW(static_cast<void>(checked_shape(0, 3, 1, "a")), InputError);
    EXPECT_THROW(static_cast<void>(checked_shape(1, kMaxFrameSide + 1, 1, "a")), InputError);
    EXPECT_THROW(static_cast<void>(checked_shape(1, 1, 2, "a")), InputError);
    EXPECT_THROW(static_cast<void>(checked_shape(kMaxFrameSide, kMaxFrameSide, 1, "a")),
                 InputError);
}

TEST(LightTest, AnImageIsNoLargerThanItsFileCanBeUnpackedTo) {
    check_packed(2 * kDeflateRatio * 10, 10, "a");
    EXPECT_THROW(check_packed(2 * kDeflateRatio * 11, 10, "a"), InputError);
    EXPECT_THROW(check_packed(4 * 11, 10, "a", 2), InputError);
}

TEST(LightTest, TheFirstValueThatIsNoLightIsNamed) {
    constexpr FrameShape kShape{2, 3, 3};
    for (const float wrong :
         {-1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        std::vector<float> light(kShape.sites());
        check_light(light, kShape, "a");
        light[6 * 2 + 3 + 1] = light.back() = wrong;  // plane 2, row 1, column 1
        EXPECT_THAT([&] { check_light(light, kShape, "a.npy"); },
                    testing::ThrowsMessage<InputError>(testing::AllOf(
                        testing::HasSubstr("a.npy"), testing::HasSubstr("row 1"),
                        testing::HasSubstr("column 1"), testing::HasSubstr("plane 2"))));
    }
}

TEST(LightTest, NegativeLightIsTakenWhereItIsAllowed) {
    constexpr FrameShape kShape{1, 2, 1};
    check_light(std::vector<float>{-1, 1}, kShape, "a", true);
    for (const float wrong :
         {-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()})
        EXPECT_THROW(check_light(std::vector<float>{1, wrong}, kShape, "a", true), InputError);
}

TEST(LightTest, LuminanceHasTheWeightsOfRec709) {
    const std::vector<float> rgb{1, 0, 0, 2, 0, 1, 0, 2, 0, 0, 1, 2};
    std::vector<float> luminance(4);
    reduce_to_luminance(rgb, luminance);
    const std::vector<float> wanted{0.2126F, 0.7152F, 0.0722F, 2};
    for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_FLOAT_EQ(luminance[i], wanted[i]);
}

}  // namespace
}  // namespace stipple
