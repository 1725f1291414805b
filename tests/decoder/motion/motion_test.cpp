#include "decoder/motion/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <utility>

#include "core/parallel.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 64, .cols = 96, .planes = 1};

/// A smooth texture that has moved by (`down`, `right`) pixels.
void draw_texture(FluxVideo& video, int slot, double down, double right) {
    for (int plane = 0; plane < video.shape().planes; ++plane)
        for (int row = 0; row < video.shape().rows; ++row)
            for (int col = 0; col < video.shape().cols; ++col) {
                const double y = row - down;
                const double x = col - right;
                const double value = 0.3 + 0.1 * std::sin(0.5 * x + 0.2 * y) +
                                     0.1 * std::sin(0.3 * y - 0.17 * x + 1) +
                                     0.05 * std::sin(0.8 * y + 0.7 * x);
                video.plane(slot, plane)(row, col) = static_cast<float>(value);
            }
}

/// The texture, moving by (`down`, `right`) pixels a slot.
FluxVideo moving_texture(int slots, FrameShape shape, double down, double right) {
    FluxVideo video(slots, shape);
    for (int slot = 0; slot < slots; ++slot) draw_texture(video, slot, slot * down, slot * right);
    return video;
}

/// The median of what is confident in the middle of a slot's frame, in pixels.
double median_shift(const std::vector<std::int16_t>& shift, const MotionField& field, int slot) {
    std::vector<std::int16_t> confident;
    for (int row = 12; row < kShape.rows - 12; ++row)
        for (int col = 12; col < kShape.cols - 12; ++col) {
            const auto i = static_cast<std::size_t>((slot * kShape.rows + row) * kShape.cols + col);
            if (field.confidence[i] > 128) confident.push_back(shift[i]);
        }
    EXPECT_GE(confident.size(), 2850U) << "of 2880";
    std::ranges::nth_element(confident, confident.begin() + static_cast<int>(confident.size()) / 2);
    return confident[confident.size() / 2] / static_cast<double>(MotionField::kShiftsPerPixel);
}

TEST(MotionTest, FindsATranslationForwardsAndBackwards) {
    const FluxVideo video = moving_texture(4, kShape, -0.75, 2.25);
    const auto fields = estimate_motion(video, {});
    ASSERT_EQ(fields.size(), 2U);
    EXPECT_EQ(fields[0].step, 1);
    EXPECT_EQ(fields[1].step, -1);
    // A tenth of a pixel is what dense inverse search is good for on smooth texture.
    EXPECT_NEAR(median_shift(fields[0].row_shift, fields[0], 1), -0.75, 0.1);
    EXPECT_NEAR(median_shift(fields[0].col_shift, fields[0], 1), 2.25, 0.1);
    EXPECT_NEAR(median_shift(fields[1].row_shift, fields[1], 2), 0.75, 0.1);
    EXPECT_NEAR(median_shift(fields[1].col_shift, fields[1], 2), -2.25, 0.1);
}

// Estimates at rest show a pixel for as long as an exposure where it is not.
TEST(MotionTest, RoughMotionIsThatOfSeveralSlots) {
    FluxVideo video(8, kShape);
    for (int slot = 0; slot < 8; ++slot) draw_texture(video, slot, 0, slot / 2);
    const auto shift_of = [&](const MotionOptions& options, int slot) {
        const auto fields = estimate_motion(video, options);
        return median_shift(fields[0].col_shift, fields[0], slot);
    };
    EXPECT_NEAR(shift_of({}, 3), 1, 0.1);
    EXPECT_NEAR(shift_of({}, 4), 0, 0.1);
    EXPECT_NEAR(shift_of({.coarse = true}, 3), 0.5, 0.15);
    EXPECT_NEAR(shift_of({.coarse = true}, 4), 0.5, 0.15);
}

TEST(MotionTest, HasNoConfidenceWhereThereIsNoPartner) {
    const FluxVideo video = moving_texture(3, kShape, 0, 6);
    const auto fields = estimate_motion(video, {});
    const std::size_t pixels = kShape.pixels();
    for (std::size_t i = 0; i < pixels; ++i) {
        EXPECT_EQ(fields[0].confidence[2 * pixels + i], 0) << "no slot after the last";
        EXPECT_EQ(fields[1].confidence[i], 0) << "no slot before the first";
    }
    for (const MotionField& field : fields)
        for (std::size_t i = 0; i < 3 * pixels; ++i) {
            if (field.confidence[i] == 0) continue;
            const auto pixel = static_cast<int>(i % pixels);
            const double row = pixel / kShape.cols + field.row_shift[i] / 64.0;
            const double col = pixel % kShape.cols + field.col_shift[i] / 64.0;
            ASSERT_TRUE(row >= 0 && row < kShape.rows - 0.99) << row;  // rounded to 1 / 64
            ASSERT_TRUE(col >= 0 && col < kShape.cols - 0.99) << col;
        }
}

TEST(MotionTest, DistrustsWhatDoesNotLeadBack) {
    const auto mean_confidence = [](const FluxVideo& video) {
        const auto fields = estimate_motion(video, {});
        double sum = 0;
        for (std::size_t i = 0; i < kShape.pixels(); ++i) sum += fields[0].confidence[i];
        return sum / static_cast<double>(kShape.pixels());
    };
    // Without the row or column that leaves the frame, 1 in 64, and some next to it.
    for (const auto& [down, right] : {std::pair{0, 1}, {0, -1}, {1, 0}, {-1, 0}})
        EXPECT_GT(mean_confidence(moving_texture(2, kShape, down, right)), 245)
            << down << " down, " << right << " right";
    FluxVideo video = moving_texture(2, kShape, 1, 1);
    const auto noise = random_values(kShape.sites(), 0, 1, 3);  // slot 1 has nothing of slot 0
    std::ranges::copy(noise, video.frame(1).begin());
    EXPECT_LT(mean_confidence(video), 10);
}

// 255 exp(-e^2 / 2) of the distance e that is left after motion to the other slot and back. Steps
// of the exponent by 1 / 16 are off by up to 1 / 32.
TEST(MotionTest, ConfidenceIsThatOfTheDistanceAfterMotionForthAndBack) {
    constexpr double kTolerance = 255.0 / 32 + 0.5;
    FluxVideo video = moving_texture(2, kShape, 1.5, 2.25);
    const auto noise = random_values(kShape.sites(), -0.15F, 0.15F, 3);
    std::ranges::transform(video.frame(1), noise, video.frame(1).begin(), std::plus<float>());
    const auto fields = estimate_motion(video, {});
    const std::size_t pixels = kShape.pixels();
    int checked = 0, doubtful = 0;
    for (const std::size_t slot : {0U, 1U})
        for (std::size_t i = 0; i < pixels; ++i) {
            const MotionField &forth = fields[slot], &back = fields[1 - slot];
            const std::size_t from = slot * pixels + i;
            const auto row_of =
                std::lround(static_cast<double>(i / 96) + forth.row_shift[from] / 64.0);
            const auto col_of =
                std::lround(static_cast<double>(i % 96) + forth.col_shift[from] / 64.0);
            const auto to = (1 - slot) * pixels + static_cast<std::size_t>(row_of * 96 + col_of);
            // Motion out of the frame is not in the fields.
            if (forth.confidence[from] == 0 || back.confidence[to] == 0) continue;
            const double down = (forth.row_shift[from] + back.row_shift[to]) / 64.0;
            const double right = (forth.col_shift[from] + back.col_shift[to]) / 64.0;
            const double expected = 255 * std::exp(-(down * down + right * right) / 2);
            ASSERT_NEAR(forth.confidence[from], expected, kTolerance) << slot << ' ' << i;
            ++checked;
            if (down * down > 0.25) ++doubtful;
        }
    EXPECT_GT(checked, 10000) << "of 12288";
    EXPECT_GT(doubtful, 20) << "the test means something";
}

TEST(MotionTest, ColourMovesAsItsLuminance) {
    FrameShape colour = kShape;
    colour.planes = 3;
    const auto mono = estimate_motion(moving_texture(3, kShape, 1, 0.5), {});
    const auto rgb = estimate_motion(moving_texture(3, colour, 1, 0.5), {});
    // Luminance of equal planes is their value but for rounding, which 8 bits seldom show.
    EXPECT_NEAR(median_shift(rgb[0].row_shift, rgb[0], 0),
                median_shift(mono[0].row_shift, mono[0], 0), 1.0 / 64);
}

TEST(MotionTest, GivesTheSameBitsForAnyNumberOfThreads) {
    const FluxVideo video = moving_texture(6, kShape, 1.3, -0.6);
    const auto motion = [&](int threads) {
        const ThreadLimit limit(threads);
        return estimate_motion(video, {});
    };
    const auto one = motion(1);
    const auto two = motion(2);
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].row_shift, two[i].row_shift);
        EXPECT_EQ(one[i].col_shift, two[i].col_shift);
        EXPECT_EQ(one[i].confidence, two[i].confidence);
    }
}

TEST(MotionTest, DoesNotDependOnTheThreadsOfOpenCv) {
    const FluxVideo video = moving_texture(2, kShape, 1.3, -0.6);
    const int threads = cv::getNumThreads();
    std::vector<std::int16_t> first;
    for (const int count : {1, 3, 8}) {
        cv::setNumThreads(count);
        const auto fields = estimate_motion(video, {});
        if (first.empty()) first = fields[0].col_shift;
        EXPECT_EQ(fields[0].col_shift, first) << count;
    }
    cv::setNumThreads(threads);
}

}  // namespace
}  // namespace stipple
