#include "decoder/motion/inverse_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/decoder/recordings.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

/// Grey levels of an image that goes on beyond its border.
template <typename Level>
class Image {
  public:
    Image(int rows, int cols, const Level& level) : rows_(rows), cols_(cols) {
        for (int row = -kFlowBorder; row < rows + kFlowBorder; ++row)
            for (int col = -kFlowBorder; col < cols + kFlowBorder; ++col)
                pixels_.push_back(static_cast<std::uint8_t>(std::lround(level(row, col))));
    }
    [[nodiscard]] FlowImage image() const {
        const std::ptrdiff_t stride = cols_ + 2 * kFlowBorder;
        return {pixels_.data() + kFlowBorder * (stride + 1), stride, rows_, cols_};
    }

  private:
    int rows_;
    int cols_;
    std::vector<std::uint8_t> pixels_;
};

double texture(double row, double col) {
    return 128 + 40 * std::sin(0.5 * col + 0.2 * row) + 40 * std::sin(0.45 * row - 0.17 * col + 1) +
           20 * std::sin(0.8 * row + 0.7 * col);
}

/// The texture after it has moved.
auto moved_texture(double down, double right) {
    return [=](int row, int col) { return texture(row - down, col - right); };
}

/// In pixels; of the pixels between two columns, and `margin` rows from the border.
double largest_error(const DenseFlow& flow, int begin_col, int end_col, double down, double right) {
    constexpr int kMargin = 4;
    double largest = 0;
    for (int row = kMargin; row < flow.rows - kMargin; ++row)
        for (int col = begin_col; col < end_col; ++col) {
            const auto i = static_cast<std::size_t>(row * flow.cols + col);
            largest = std::max({largest, std::abs(flow.row_shift[i] / 64.0 - down),
                                std::abs(flow.col_shift[i] / 64.0 - right)});
        }
    return largest;
}

TEST(InverseSearchTest, FindsWhereATextureWent) {
    const Image from(50, 61, moved_texture(0, 0));
    for (const int stride : {3, 4, 6, 8}) {
        const Image to(50, 61, moved_texture(1.25, -1.5));
        const DenseFlow flow =
            inverse_search(from.image(), to.image(), nullptr, {.patch_stride_px = stride});
        ASSERT_EQ(flow.rows, 50);
        ASSERT_EQ(flow.cols, 61);
        // The search ends with steps below 1/32 of a pixel.
        EXPECT_LT(largest_error(flow, 4, 57, 1.25, -1.5), 0.05) << stride;
    }
}

TEST(InverseSearchTest, IsAtRestWithoutTexture) {
    const Image grey(20, 30, [](int, int) { return 77; });
    const DenseFlow flow = inverse_search(grey.image(), grey.image(), nullptr, {});
    EXPECT_TRUE(std::ranges::all_of(flow.row_shift, [](int shift) { return shift == 0; }));
    EXPECT_TRUE(std::ranges::all_of(flow.col_shift, [](int shift) { return shift == 0; }));
}

TEST(InverseSearchTest, DoesNotMindAnotherMeanLight) {
    const Image from(40, 40, moved_texture(0, 0));
    const Image brighter(40, 40, [](int row, int col) { return 20 + texture(row, col - 1); });
    const DenseFlow flow = inverse_search(from.image(), brighter.image(), nullptr, {});
    EXPECT_LT(largest_error(flow, 4, 36, 0, 1), 0.05);
}

// A patch that lies across the border may follow either side: 8 pixels, 4 of them on each side.
TEST(InverseSearchTest, KeepsTheBorderOfTwoMotions) {
    const Image from(48, 80, moved_texture(0, 0));
    const Image to(48, 80, [](int row, int col) {
        return col < 40 ? texture(row, col) : texture(row - 1.5, col);
    });
    const DenseFlow flow = inverse_search(from.image(), to.image(), nullptr, {});
    EXPECT_LT(largest_error(flow, 4, 34, 0, 0), 0.05);
    EXPECT_LT(largest_error(flow, 46, 76, 1.5, 0), 0.05);
}

TEST(InverseSearchTest, GoesFartherThanAPatchFromTheCoarserFlow) {
    const Image from(40, 64, moved_texture(0, 0));
    const Image to(40, 64, moved_texture(0, 14.5));
    const DenseFlow coarser{20, 32, std::vector<std::int16_t>(20 * 32, 0),
                            std::vector<std::int16_t>(20 * 32, 7 * kFlowShiftsPerPixel)};
    const DenseFlow flow = inverse_search(from.image(), to.image(), &coarser, {});
    EXPECT_LT(largest_error(flow, 4, 46, 0, 14.5), 0.05);
    const DenseFlow from_rest = inverse_search(from.image(), to.image(), nullptr, {});
    EXPECT_GT(largest_error(from_rest, 4, 46, 0, 14.5), 1);
}

// The long waves on the left lead the way; from rest, the short ones end a wave too early.
TEST(InverseSearchTest, FollowsItsNeighbours) {
    const auto waves = [](double right) {
        return Image(48, 80, [=](double row, double col) {
            const double x = col - right;
            return x < 36 ? 128 + 60 * std::sin(0.25 * x + 0.1 * row) + 60 * std::sin(0.3 * row)
                          : 128 + 60 * std::sin(1.2 * x + 0.3 * row) +
                                60 * std::sin(1.1 * row - 0.4 * x);
        });
    };
    const DenseFlow flow = inverse_search(waves(0).image(), waves(3.5).image(), nullptr, {});
    EXPECT_LT(largest_error(flow, 4, 72, 0, 3.5), 0.1);
}

// Shifts that differ by much more than `range_sigma_px` are not averaged.
TEST(InverseSearchTest, AveragesWhatIsAlike) {
    constexpr int kSide = 64;
    constexpr int kStride = kSide + 2 * kFlowBorder;
    const auto noisy = [](double down, unsigned seed) {
        const auto noise = random_values(kStride * kStride, -20, 20, seed);
        return Image(kSide, kSide, [=](int row, int col) {
            const int i = (row + kFlowBorder) * kStride + col + kFlowBorder;
            return texture(row - down, col) +
                   static_cast<double>(noise[static_cast<std::size_t>(i)]);
        });
    };
    const Image from = noisy(0, 1);
    const Image to = noisy(0.5, 2);
    const auto error = [&](float range_sigma_px) {
        return largest_error(
            inverse_search(from.image(), to.image(), nullptr, {.range_sigma_px = range_sigma_px}),
            4, 60, 0.5, 0);
    };
    EXPECT_LT(error(1), 0.21 * error(1e-4F));
}

TEST(InverseSearchTest, EverySimdTargetGivesTheSameBits) {
    for (const auto& [rows, cols] : {std::pair(8, 8), std::pair(9, 45), std::pair(33, 70)}) {
        const Image from(rows, cols, moved_texture(0, 0));
        const Image to(rows, cols, moved_texture(-0.7, 3.2));
        std::vector<DenseFlow> flows;
        for_each_simd_target([&](const std::string& target) {
            flows.push_back(inverse_search(from.image(), to.image(), nullptr, {}));
            EXPECT_EQ(flows.back().row_shift, flows.front().row_shift) << target;
            EXPECT_EQ(flows.back().col_shift, flows.front().col_shift) << target;
        });
    }
}

}  // namespace
}  // namespace stipple
