#include "core/index.h"

#include <gtest/gtest.h>

#include <array>

namespace stipple {
namespace {

static_assert(index(0) == 0 && index(std::int64_t{1} << 40U) == std::size_t{1} << 40U);

TEST(IndexTest, RowMajorCountsTheElementsOfAnArrayInTheOrderOfMemory) {
    constexpr int kRows = 3;
    constexpr int kCols = 5;
    const std::array<std::array<int, kCols>, kRows> array{};
    for (int row = 0; row < kRows; ++row)
        for (int col = 0; col < kCols; ++col) {
            const int* const element = &array[index(row)][index(col)];
            EXPECT_EQ(row_major(row, col, kCols),
                      static_cast<std::size_t>(element - array.front().data()));
        }
}

TEST(IndexTest, RowMajorHoldsForTheLargestFrame) {
    EXPECT_EQ(row_major(65534, 65534, 65535), std::size_t{65535} * 65535 - 1);
}

}  // namespace
}  // namespace stipple
