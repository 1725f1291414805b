#include "sensor_model/normal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/philox.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

constexpr std::uint32_t kStride = 0x3FF1;  // odd: meets all low-bit patterns; 262 000 words

// The deviate z of tail probability t has erfc(z / sqrt(2)) / 2 = t; a wrong probability dt is a
// wrong deviate dt / density(z). Single precision carries 2^-24 of z through about ten roundings.
TEST(NormalTest, IsTheQuantileOfItsWordToSinglePrecision) {
    for (std::uint64_t word = 0; word < 0x100000000; word += 2 * kStride) {
        const auto z = static_cast<double>(normal_one(static_cast<std::uint32_t>(word)));
        const double tail = (static_cast<double>(word / 2) + 0.5) * 0x1p-32;
        const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
        const double error = (std::erfc(z / std::numbers::sqrt2) / 2 - tail) / density;
        ASSERT_LE(std::abs(error), 10 * 0x1p-24 * std::max(z, 0.01)) << "word " << word;
    }
}

TEST(NormalTest, FlipsItsSignWithBitZero) {
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const std::uint32_t word = i * 4294967U & ~1U;
        EXPECT_EQ(normal_one(word | 1U), -normal_one(word));
    }
    EXPECT_LT(normal_one(1), 0);
}

TEST(NormalTest, StaysWithinTheTailOfAWord) {
    // The smallest tail is 2^-33: z = 6.33796 (erfc in 30 digits).
    EXPECT_NEAR(normal_one(0), 6.33796, 1e-5);
    EXPECT_NEAR(normal_one(0xFFFFFFFE), 0, 1e-9);
}

TEST(NormalTest, HasTheMomentsOfAStandardNormal) {
    double sum = 0, sum2 = 0, sum4 = 0, words = 0;
    for (std::uint64_t word = 600; word < 0x100000000; word += 2 * 601) {
        const auto z = static_cast<double>(normal_one(static_cast<std::uint32_t>(word)));
        sum += z;
        sum2 += z * z;
        sum4 += z * z * z * z;
        ++words;
    }
    // Equally spaced probabilities are a midpoint rule; what it leaves out beyond the largest
    // word's deviate is below 1e-5 of the fourth moment.
    EXPECT_NEAR(sum / words, std::sqrt(2 / std::numbers::pi), 1e-6);  // |z|: even words are >= 0
    EXPECT_NEAR(sum2 / words, 1, 2e-6);
    EXPECT_NEAR(sum4 / words, 3, 1e-4);
}

TEST(NormalTest, IsTheSameBitsOnEverySimdTarget) {
    std::vector<std::uint32_t> words;
    for (std::uint64_t word = 0; word < 0x100000000; word += kStride)
        words.push_back(static_cast<std::uint32_t>(word));
    for (const std::uint32_t word : {0U, 1U, 2U, 3U, 0xFFFFFFFEU, 0xFFFFFFFFU})
        words.push_back(word);
    for_each_simd_target([&](const std::string& target) {
        std::vector<float> values(words.size());
        normal(words, values);
        for (std::size_t i = 0; i < words.size(); ++i)
            ASSERT_EQ(values[i], normal_one(words[i])) << target << " word " << words[i];
    });
}

}  // namespace
}  // namespace stipple
