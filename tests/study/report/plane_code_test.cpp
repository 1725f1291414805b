#include "study/report/report_page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/study/report/recorded_clip.h"

namespace stipple {
namespace {

TEST(PlaneCodeTest, TheLightOfACodeIsWithinHalfAStep) {
    const double half_step = std::exp2(0.5 / kCodesPerStop) - 1;  // 0.27 %, and rounding of log2f
    for (float light = 1.0F / 16384; light < 60000; light *= 1.0009F) {
        const double coded = light_of_code(light_code(light));
        EXPECT_NEAR(coded / static_cast<double>(light), 1, 1.05 * half_step) << light;
    }
}

TEST(PlaneCodeTest, NoLightIsCodeZero) {
    for (const float light : {0.0F, -1.0F, 1e-6F, std::numeric_limits<float>::quiet_NaN()})
        EXPECT_EQ(light_code(light), 0) << light;
    EXPECT_EQ(light_of_code(0), 0);
    EXPECT_EQ(light_code(static_cast<float>(kDarkestCodedLight)), 1);
}

TEST(PlaneCodeTest, TheBrightestLightHasACode) {
    const auto most = static_cast<double>(std::numeric_limits<float>::max());
    EXPECT_NEAR(light_of_code(light_code(std::numeric_limits<float>::max())) / most, 1, 0.003);
    EXPECT_EQ(light_code(std::numeric_limits<float>::infinity()), 65535);
}

TEST(PlaneCodeTest, AnotherReaderUnpacksThePlane) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    for (const std::size_t count : {1U, 2U, 3U, 1000U}) {
        std::vector<std::uint16_t> values(count);
        for (std::uint16_t& value : values) value = static_cast<std::uint16_t>(random());
        for (const std::size_t step : {1U, 3U})
            EXPECT_EQ(unpacked_plane(packed_plane(values, step), step), values);
    }
    const std::vector<std::uint16_t> extremes{65535, 0, 65535, 32768, 0, 32767, 1};
    EXPECT_EQ(unpacked_plane(packed_plane(extremes)), extremes);
}

TEST(PlaneCodeTest, ColoursThatTakeTurnsAreSmallIfEachIsSmooth) {
    std::mt19937 random(1);
    std::vector<std::uint16_t> values{0, 20000, 40000};
    while (values.size() < 9999)  // each colour rises by 0 or 1
        values.push_back(static_cast<std::uint16_t>(values[values.size() - 3] + random() % 2));
    EXPECT_LT(packed_plane(values, 3).size(), packed_plane(values).size() / 2);
}

TEST(PlaneCodeTest, ASmoothPlaneIsSmall) {
    std::vector<std::uint16_t> values(10000);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint16_t>(i / 3);
    EXPECT_LT(packed_plane(values).size(), values.size() / 20);
}

}  // namespace
}  // namespace stipple
