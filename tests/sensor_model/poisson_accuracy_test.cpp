// The draw is a step function of the ordered word, so the distribution over all 2^32 words follows
// from the places of its steps, found by bisection: accuracy is computed, not sampled.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "sensor_model/poisson.h"
#include "tests/sensor_model/ordered_words.h"

namespace stipple {
namespace {

/// First rank in [from, kWords] whose draw exceeds k.
std::uint64_t first_rank_above(float mean, std::uint32_t k, std::uint64_t from) {
    std::uint64_t to = kWords;
    while (from < to) {
        const std::uint64_t middle = (from + to) / 2;
        if (poisson_one(mean, ordered_word(middle)) > k)
            to = middle;
        else
            from = middle + 1;
    }
    return from;
}

struct Deviation {
    double total_variation = 0;
    double mean_error_e = 0;
    double variance_error = 0;  ///< relative
};

Deviation deviation(float mean) {
    const auto m = static_cast<long double>(mean);
    long double distance = 0, first_moment = 0, second_moment = 0;
    std::uint64_t rank = 0;
    for (std::uint32_t k = poisson_one(mean, ordered_word(0)); rank < kWords; ++k) {
        const std::uint64_t end = first_rank_above(mean, k, rank);
        const long double drawn = static_cast<long double>(end - rank) / kWords;
        const long double exact = std::exp(k * std::log(m) - m - std::lgamma(k + 1.0L));
        distance += std::abs(drawn - exact) / 2;
        first_moment += (k - m) * drawn;
        second_moment += (k - m) * (k - m) * drawn;
        rank = end;
    }
    const long double variance = second_moment - first_moment * first_moment;
    return {static_cast<double>(distance), static_cast<double>(first_moment),
            static_cast<double>(variance / m - 1)};
}

struct Bound {
    float mean;
    double total_variation;
};

void PrintTo(const Bound& bound, std::ostream* out) {
    *out << "mean " << bound.mean;
}

class PoissonAccuracyTest : public testing::TestWithParam<Bound> {};

// The bounds are the accuracy table of docs/sensor_model.md. A word of 32 bits cannot do better
// than about 2^-33 for each of the k that occur.
TEST_P(PoissonAccuracyTest, TotalVariationStaysWithinTheDocumentedBound) {
    const auto [mean, bound] = GetParam();
    const Deviation found = deviation(mean);
    RecordProperty("total_variation", std::to_string(found.total_variation));
    EXPECT_LE(found.total_variation, bound);
    // Shifting the fraction `bound` of the words by about one count moves the mean by about as
    // much, and the variance, in units of the mean, by that times the deviations' size.
    EXPECT_LE(std::abs(found.mean_error_e), 10 * bound + 1e-9);
    EXPECT_LE(std::abs(found.variance_error), 10 * bound + 3e-8);
}

INSTANTIATE_TEST_SUITE_P(Summed, PoissonAccuracyTest,
                         testing::Values(Bound{0.01F, 3e-9}, Bound{0.1F, 3e-9}, Bound{1, 3e-9},
                                         Bound{3.99F, 3e-9}, Bound{4, 3e-9}, Bound{5, 3e-9},
                                         Bound{10, 3e-9}, Bound{16, 3e-9}, Bound{25, 3e-9},
                                         Bound{31.999F, 3e-9}));
INSTANTIATE_TEST_SUITE_P(Expanded, PoissonAccuracyTest,
                         testing::Values(Bound{32, 1.6e-6}, Bound{50, 1e-6}, Bound{99.99F, 6e-7},
                                         Bound{100, 6e-7}, Bound{300, 7e-7}, Bound{1000, 9e-7},
                                         Bound{3000, 1.6e-6}, Bound{8000, 2.6e-6},
                                         Bound{20000, 4.5e-6}));

}  // namespace
}  // namespace stipple
