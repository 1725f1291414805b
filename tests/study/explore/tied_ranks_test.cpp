#include "study/explore/ranking.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>
#include <vector>

namespace stipple {
namespace {

/// The ranks as texts, with blanks between them.
std::string ranks_of(const std::vector<std::vector<double>>& points) {
    std::string text;
    for (const Rank rank : tied_ranks(points)) text += (text.empty() ? "" : " ") + text_of(rank);
    return text;
}

TEST(TiedRanksTest, DifferencesThatMayBeZeroAreTies) {
    // Differences from the first: 0.1 +- 0.25 by t = 4.30 and s = 0.1, then 0.5 +- 0.25.
    EXPECT_EQ(ranks_of({{30, 31, 29}, {29.9, 31, 28.8}, {29.5, 30.6, 28.4}}), "1= 1= 3");
    EXPECT_EQ(ranks_of({{29.5, 30.6, 28.4}, {30, 31, 29}, {29.9, 31, 28.8}}), "3 1= 1=");
    EXPECT_EQ(ranks_of({{30, 31, 29}, {20, 21, 19.1}, {20, 21, 19}}), "1 2= 2=");
}

TEST(TiedRanksTest, NoiseThatAllPointsShareDoesNotTieThem) {
    // The intervals of the means overlap by far; the differences are 0.1 each.
    EXPECT_EQ(ranks_of({{25, 30, 35}, {25.1, 30.1, 35.1}}), "2 1");
    std::mt19937 random(3);
    std::normal_distribution<double> scene(30, 2), own(0, 0.05);
    std::vector<std::vector<double>> points(4, std::vector<double>(5));
    for (std::size_t seed = 0; seed < 5; ++seed) {
        const double shared = scene(random);
        for (std::size_t i = 0; i < 4; ++i)
            points[i][seed] = shared + 0.5 * static_cast<double>(i) + own(random);
    }
    EXPECT_EQ(ranks_of(points), "4 3 2 1");
}

TEST(TiedRanksTest, AllThatMayBeTheBestShareItsRank) {
    // The last one varies so much that it may be the best, though its mean is the least.
    EXPECT_EQ(ranks_of({{30, 30, 30}, {29, 29, 29}, {34, 22, 30}}), "1= 2 1=");
}

TEST(TiedRanksTest, EqualPointsAreSeldomToldApart) {
    // One in twenty pairs by chance; 4000 pairs have a standard error of 0.35 %.
    std::mt19937 random(4);
    std::normal_distribution<double> normal(30, 0.5);
    int told = 0;
    for (int run = 0; run < 4000; ++run) {
        std::vector<std::vector<double>> pair(2, std::vector<double>(5));
        for (auto& samples : pair)
            for (double& sample : samples) sample = normal(random);
        told += tied_ranks(pair)[0].is_tied ? 0 : 1;
    }
    EXPECT_NEAR(told / 4000.0, 0.05, 0.014);
}

TEST(TiedRanksTest, InfiniteFiguresHaveRanks) {
    const double infinite = std::numeric_limits<double>::infinity();
    EXPECT_EQ(ranks_of({{30, 31}, {infinite, infinite}, {infinite, infinite}}), "3 1= 1=");
    EXPECT_EQ(ranks_of({}), "");
    EXPECT_EQ(ranks_of({{1, 2}}), "1");
    EXPECT_EQ(text_of(Rank()), "");
}

}  // namespace
}  // namespace stipple
