#include "sensor_model/poisson.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/philox.h"
#include "tests/sensor_model/ordered_words.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

constexpr std::uint64_t kSeed = 20;

/// Every mean at and beside a border of a method, then zero, tiny, and beyond every sensor.
const std::vector<float> kBorderMeans = {
    0.0F,      1e-38F, 1e-6F,      3.9999998F, 4.0F, 4.0000005F, 31.999998F, 32.0F,    32.000004F,
    99.99999F, 100.0F, 100.00001F, 8388608.0F, 1e6F, 1e9F,       1e10F,      HUGE_VALF};

/// Means spread evenly over the powers of two from 2^-4 to 2^16, without libm.
float spread_mean(std::uint32_t word) {
    return std::ldexp(1.0F + static_cast<float>(word >> 16U) * 0x1p-16F,
                      static_cast<int>(word % 20) - 4);
}

struct Draws {
    std::vector<float> mean;
    std::vector<std::uint32_t> word;
    std::vector<std::uint32_t> expected;

    void add(float m, std::uint32_t w) {
        mean.push_back(m);
        word.push_back(w);
        expected.push_back(poisson_one(m, w));
    }
};

void expect_same_on_every_target(const Draws& draws) {
    for_each_simd_target([&](const std::string& target) {
        std::vector<std::uint32_t> counts(draws.mean.size());
        poisson(draws.mean, draws.word, counts);
        for (std::size_t i = 0; i < counts.size(); ++i)
            ASSERT_EQ(counts[i], draws.expected[i])
                << target << " mean " << draws.mean[i] << " word " << draws.word[i];
    });
}

TEST(PoissonTest, MixedMeansGiveTheSameDrawsOnEverySimdTarget) {
    Draws draws;
    for (std::uint32_t i = 0; i < 1000003; ++i) {
        const PhiloxCounter random = philox4x32({i, 0, 0, 0}, kSeed);
        draws.add(spread_mean(random[0]), random[1]);
    }
    expect_same_on_every_target(draws);
}

TEST(PoissonTest, EqualMeansGiveTheSameDrawsOnEverySimdTarget) {
    Draws draws;
    for (std::uint32_t i = 0; i < 1000000; ++i) {
        const float mean = spread_mean(philox4x32({i / 1000, 1, 0, 0}, kSeed)[0]);
        draws.add(mean, philox4x32({i, 2, 0, 0}, kSeed)[0]);
    }
    expect_same_on_every_target(draws);
}

TEST(PoissonTest, BordersOfTheMethodsGiveTheSameDrawsOnEverySimdTarget) {
    Draws draws;
    for (const float mean : kBorderMeans) {
        for (const std::uint32_t word : {0U, 1U, 2U, 3U, 0xFFFFFFFEU, 0xFFFFFFFFU})
            draws.add(mean, word);
        for (std::uint32_t i = 0; i < 20000; ++i)
            draws.add(mean, philox4x32({i, 3, 0, 0}, kSeed)[0]);
    }
    expect_same_on_every_target(draws);
}

TEST(PoissonTest, NoLightGivesNoPhotons) {
    for (const std::uint32_t word : {0U, 1U, 0x80000000U, 0xFFFFFFFEU, 0xFFFFFFFFU})
        EXPECT_EQ(poisson_one(0, word), 0U);
}

TEST(PoissonTest, MeansBeyondTheLargestAreTakenAsTheLargest) {
    for (const std::uint32_t word : {0U, 1U, 0x12345678U})
        EXPECT_EQ(poisson_one(HUGE_VALF, word), poisson_one(kMaxPoissonMean, word));
}

// Exact for summed draws; the expansion's roundings (float, 1e-6 of the words) may put two
// neighbouring words in the wrong order, by one count.
TEST(PoissonTest, RisesWithTheOrderedWord) {
    for (const float mean : {0.5F, 3.0F, 4.0F, 12.0F, 31.0F, 60.0F, 1000.0F, 8000.0F}) {
        const std::uint32_t slack = mean < 32 ? 0 : 1;
        std::uint32_t previous = 0;
        for (std::uint64_t rank = 0; rank < kWords; rank += 20011) {
            const std::uint32_t count = poisson_one(mean, ordered_word(rank));
            ASSERT_GE(count + slack, previous) << "mean " << mean << " rank " << rank;
            previous = std::max(previous, count);
        }
    }
}

// The methods differ by less than 2e-6 in probability, so at most a few words in 500 000 may drop,
// by one count, where one method takes over from another; none elsewhere.
TEST(PoissonTest, RisesWithTheMean) {
    int drops = 0;
    for (std::uint32_t i = 0; i < 5000; ++i) {
        const std::uint32_t word = philox4x32({i, 4, 0, 0}, kSeed)[0];
        std::uint32_t previous = 0;
        for (float mean = 0.1F; mean < 20000; mean *= 1.125F) {
            const std::uint32_t count = poisson_one(mean, word);
            ASSERT_GE(count + 1, previous) << "mean " << mean << " word " << word;
            drops += count < previous ? 1 : 0;
            previous = count;
        }
    }
    EXPECT_LE(drops, 5);
}

}  // namespace
}  // namespace stipple
