#include "readout/column_adc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

namespace stipple {
namespace {

std::uint16_t convert(const SensorParams& params, float electrons) {
    return ColumnAdc(params).convert_one(electrons);
}

/// The DN of Eq. 1 in integers: charges are multiples of 1/1024 electron, so the level is the
/// fraction steps (2^d - 1) / (1024 s).
std::int64_t exact_dn(const SensorParams& params, std::int64_t steps) {
    const std::int64_t most = (std::int64_t{1} << params.bit_depth) - 1;
    const std::int64_t below = 1024 * static_cast<std::int64_t>(params.full_scale_e);
    if (steps <= 0) return 0;
    if (steps >= below) return most;
    const std::int64_t half = params.rounding == Rounding::kNearest ? below / 2 : 0;
    return (steps * most + half) / below;
}

TEST(ColumnAdcTest, IsEquationOneInIntegers) {
    std::mt19937 random(1);
    for (const int bit_depth : {1, 2, 8, 10, 12, 16})
        for (const Rounding rounding : {Rounding::kNearest, Rounding::kFloor})
            for (const double full_scale_e : {1.0, 254.0, 2000.0, 65535.0}) {
                const SensorParams params{
                    .full_scale_e = full_scale_e, .bit_depth = bit_depth, .rounding = rounding};
                const auto steps_to_full = static_cast<std::uint32_t>(1024 * full_scale_e);
                for (int i = 0; i < 2000; ++i) {
                    // From -1/8 to 9/8 of full scale; below 2^24 steps every charge is a float.
                    const auto steps =
                        static_cast<std::int64_t>(random() % (steps_to_full * 5 / 4)) -
                        std::int64_t{steps_to_full} / 8;
                    const auto electrons = static_cast<float>(steps) / 1024;
                    if (static_cast<double>(electrons) * 1024 != static_cast<double>(steps))
                        continue;
                    ASSERT_EQ(ColumnAdc(params).convert_one(electrons), exact_dn(params, steps))
                        << bit_depth << " bits, full scale " << full_scale_e << ", charge "
                        << electrons;
                }
            }
}

TEST(ColumnAdcTest, ClipsAtFullScaleAndAtZero) {
    const SensorParams params;  // 8 bits, full scale 2000 electrons
    EXPECT_EQ(convert(params, 2000), 255);
    EXPECT_EQ(convert(params, 2001), 255);
    EXPECT_EQ(convert(params, 1e9F), 255);
    EXPECT_EQ(convert(params, std::numeric_limits<float>::infinity()), 255);
    EXPECT_EQ(convert(params, 0), 0);
    EXPECT_EQ(convert(params, -0.0F), 0);
    EXPECT_EQ(convert(params, -40), 0);
    EXPECT_EQ(ColumnAdc(params).max_dn(), 255);
}

TEST(ColumnAdcTest, RoundsHalvesUpAndFloorsBelowTheNextNumber) {
    // Full scale 510 electrons: two electrons per DN, so odd charges are halves.
    const SensorParams nearest{.full_scale_e = 510};
    EXPECT_EQ(convert(nearest, 1), 1);
    EXPECT_EQ(convert(nearest, std::nextafter(1.0F, 0.0F)), 0);
    EXPECT_EQ(convert(nearest, 3), 2);
    const SensorParams floor{.full_scale_e = 510, .rounding = Rounding::kFloor};
    EXPECT_EQ(convert(floor, std::nextafter(2.0F, 0.0F)), 0);
    EXPECT_EQ(convert(floor, 2), 1);
    EXPECT_EQ(convert(floor, std::nextafter(510.0F, 0.0F)), 254);  // 255 is full scale alone
    EXPECT_EQ(convert(floor, 510), 255);
}

TEST(ColumnAdcTest, ConvertsAListAsOneByOne) {
    const ColumnAdc adc({.bit_depth = 12});
    std::mt19937 random(2);
    for (const std::size_t count : {0U, 1U, 7U, 8U, 9U, 1000U}) {
        std::vector<float> electrons(count);
        for (float& e : electrons) e = static_cast<float>(random() % 3000000) / 1000 - 500;
        std::vector<std::uint16_t> dn(count);
        adc.convert(electrons, dn);
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(dn[i], adc.convert_one(electrons[i]));
    }
}

}  // namespace
}  // namespace stipple
