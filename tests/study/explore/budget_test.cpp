#include "study/explore/ranking.h"

#include <gtest/gtest.h>

#include <vector>

namespace stipple {
namespace {

TEST(BudgetTest, IsATimeOrANumberOfClips) {
    const auto seconds = [](const char* text) {
        const auto budget = parse_budget(text);
        return budget && budget->unit == Budget::Unit::kSeconds ? budget->amount : -1;
    };
    EXPECT_EQ(seconds("90s"), 90);
    EXPECT_EQ(seconds("10m"), 600);
    EXPECT_EQ(seconds("1.5h"), 5400);
    const auto clips = parse_budget("40");
    ASSERT_TRUE(clips);
    EXPECT_EQ(clips->unit, Budget::Unit::kClips);
    EXPECT_EQ(clips->amount, 40);
    for (const char* text :
         {"", "m", "0", "-3", "0s", "10 m", "10min", "nan", "inf", "1e999", "ten"})
        EXPECT_FALSE(parse_budget(text)) << text;
}

TEST(BudgetTest, RungsAreHalvesThatAreNotTooShort) {
    EXPECT_EQ(rungs_of(48), (std::vector{12, 24, 48}));
    EXPECT_EQ(rungs_of(100), (std::vector{25, 50, 100}));
    EXPECT_EQ(rungs_of(32), (std::vector{16, 32}));
    EXPECT_EQ(rungs_of(23), (std::vector{23}));
    EXPECT_EQ(rungs_of(1), (std::vector{1}));
}

TEST(BudgetTest, AsManyGoOnAsTheShareOfARungPaysFor) {
    const std::vector<double> costs{1, 2, 3, 4};
    EXPECT_EQ(affordable(costs, 4, 100, 100), 4);
    EXPECT_EQ(affordable(costs, 2, 100, 100), 2);
    EXPECT_EQ(affordable(costs, 4, 6, 100), 3);
    EXPECT_EQ(affordable(costs, 4, 5.9, 100), 2);
    // The share pays for none, but what is left pays for the best one.
    EXPECT_EQ(affordable(costs, 4, 0.5, 1), 1);
    EXPECT_EQ(affordable(costs, 4, 0.5, 0.9), 0);
    EXPECT_EQ(affordable({}, 4, 1, 1), 0);
}

}  // namespace
}  // namespace stipple
