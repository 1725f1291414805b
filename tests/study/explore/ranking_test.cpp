#include "study/explore/ranking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace stipple {
namespace {

/// Layers by their definition: what nothing left dominates, again and again.
std::vector<std::size_t> peeled(const std::vector<Scores>& points) {
    constexpr auto kNone = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> layers(points.size(), kNone);
    const auto beats = [](const Scores& a, const Scores& b) {
        bool all = true, one = false;
        for (std::size_t i = 0; i < a.size(); ++i) {
            all &= a[i] >= b[i];
            one |= a[i] > b[i];
        }
        return all && one;
    };
    for (std::size_t layer = 0; std::ranges::count(layers, kNone) > 0; ++layer) {
        std::vector<std::size_t> free;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (layers[i] == kNone) {
                bool beaten = false;
                for (std::size_t j = 0; j < points.size(); ++j)
                    beaten |= layers[j] == kNone && beats(points[j], points[i]);
                if (!beaten) free.push_back(i);
            }
        for (const std::size_t i : free) layers[i] = layer;
    }
    return layers;
}

TEST(RankingTest, LayersAreThoseOfTheDefinition) {
    std::mt19937 random(7);
    for (int trial = 0; trial < 50; ++trial) {
        const std::size_t measures = 1 + random() % 4;
        std::vector<Scores> points(random() % 40, Scores(measures));
        for (Scores& point : points)
            for (double& score : point) score = static_cast<double>(random() % 6);  // some equal
        EXPECT_EQ(layers_of(points), peeled(points)) << "trial " << trial;
    }
}

TEST(RankingTest, BetterLayersComeFirstAndEachPointOnce) {
    std::mt19937 random(8);
    std::vector<Scores> points(60, Scores(3));
    for (Scores& point : points)
        for (double& score : point) score = static_cast<double>(random() % 9);
    const auto layers = layers_of(points);
    auto order = ranked(points);
    EXPECT_TRUE(std::ranges::is_sorted(order, {}, [&](std::size_t i) { return layers[i]; }));
    std::ranges::sort(order);
    std::vector<std::size_t> all(points.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    EXPECT_EQ(order, all);
}

TEST(RankingTest, TheFirstOnesAreSpreadOverALayer) {
    std::vector<Scores> line;
    for (int i = 0; i < 9; ++i) line.push_back({8.0 - i, static_cast<double>(i)});
    EXPECT_EQ(ranked(line), (std::vector<std::size_t>{0, 8, 4, 2, 6, 1, 3, 5, 7}));
}

TEST(RankingTest, OneMeasureIsTheUsualOrder) {
    const std::vector<Scores> points{{2}, {5}, {2}, {9}};
    EXPECT_EQ(ranked(points), (std::vector<std::size_t>{3, 1, 0, 2}));
}

TEST(RankingTest, WhatIsNotKnownIsWorse) {
    const double nan = std::nan("");
    EXPECT_EQ(layers_of(std::vector<Scores>{{nan, 1}, {-5, 1}, {nan, nan}}),
              (std::vector<std::size_t>{1, 0, 2}));
    EXPECT_TRUE(ranked({}).empty());
    EXPECT_EQ(ranked(std::vector<Scores>{{nan}}), std::vector<std::size_t>{0});
}

}  // namespace
}  // namespace stipple
