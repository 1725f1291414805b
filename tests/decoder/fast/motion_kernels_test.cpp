#include "decoder/fast/gradient_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "decoder/motion/motion.h"
#include "tests/decoder/recordings.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

constexpr FrameShape kMono{.rows = 12, .cols = 150, .planes = 1};  // more than one stretch
constexpr FrameShape kColour{.rows = 9, .cols = 35, .planes = 3};

/// Random partners anywhere in the frame, its last row and column included.
struct Linked {
    Linked(FrameShape frame_shape, bool same_confidence)
        : shape(frame_shape),
          row_shift(shape.pixels()),
          col_shift(shape.pixels()),
          confidence(shape.pixels(), 255),
          step(random_values(shape.pixels(), 0.01F, 0.1F, 1)),
          now(random_values(shape.sites(), 0, 1, 2)),
          next(random_values(shape.sites(), 0, 1, 3)),
          dual(shape.sites()),
          gradient_now(shape.sites()),
          gradient_next(shape.sites()) {
        std::mt19937 random(4);
        const auto shift = [&](int at, int length) {
            const auto range = static_cast<unsigned>((length - 1) * MotionField::kShiftsPerPixel);
            return static_cast<std::int16_t>(static_cast<int>(random() % (range + 1)) -
                                             at * MotionField::kShiftsPerPixel);
        };
        for (std::size_t i = 0; i < shape.pixels(); ++i) {
            row_shift[i] = shift(static_cast<int>(i) / shape.cols, shape.rows);
            col_shift[i] = shift(static_cast<int>(i) % shape.cols, shape.cols);
            if (!same_confidence) confidence[i] = static_cast<std::uint8_t>(random() % 256);
        }
        row_shift[0] = static_cast<std::int16_t>((shape.rows - 1) * MotionField::kShiftsPerPixel);
        col_shift[0] = static_cast<std::int16_t>((shape.cols - 1) * MotionField::kShiftsPerPixel);
    }
    [[nodiscard]] MotionLink link() {
        return {shape, row_shift.data(), col_shift.data(), confidence.data(), dual.data()};
    }
    void update(float weight) {
        update_motion_dual(
            link(),
            {.step = step.data(), .coupling = 16, .weight = weight, .reference_step = 0.04F},
            {now.data(), next.data()}, gradient_now.data());
        add_partner_gradient(link(), gradient_next.data());
    }
    /// D of any pair of frames, in double.
    [[nodiscard]] double difference(const std::vector<float>& a, const std::vector<float>& b,
                                    std::size_t i) const {
        const std::size_t pixel = i % shape.pixels();
        const auto cols = static_cast<std::size_t>(shape.cols);
        const double row = static_cast<double>(pixel / cols) + row_shift[pixel] / 64.0;
        const double col = static_cast<double>(pixel % cols) + col_shift[pixel] / 64.0;
        const double top = std::min(std::floor(row), shape.rows - 2.0);
        const double left = std::min(std::floor(col), shape.cols - 2.0);
        const float* p =
            &b[i - pixel + static_cast<std::size_t>(top) * cols + static_cast<std::size_t>(left)];
        const double right = col - left;
        const double above =
            static_cast<double>(p[0]) * (1 - right) + static_cast<double>(p[1]) * right;
        const double below =
            static_cast<double>(p[cols]) * (1 - right) + static_cast<double>(p[cols + 1]) * right;
        return above * (1 - (row - top)) + below * (row - top) - static_cast<double>(a[i]);
    }

    FrameShape shape;
    std::vector<std::int16_t> row_shift, col_shift;
    std::vector<std::uint8_t> confidence;
    std::vector<float> step, now, next, dual, gradient_now, gradient_next;
};

TEST(MotionKernelsTest, DualsAscendAlongDifferencesToThePartner) {
    for (const FrameShape shape : {kMono, kColour}) {
        Linked f(shape, true);
        f.update(1e9F);
        for (std::size_t i = 0; i < shape.sites(); ++i) {
            const double sigma = 1 / (16.0 * static_cast<double>(f.step[i % shape.pixels()]));
            EXPECT_NEAR(f.dual[i], sigma * f.difference(f.now, f.next, i), 1e-5) << i;
        }
    }
}

/// <D (a, b), dual> = <a, gradient_now> + <b, gradient_next> for any a and b.
TEST(MotionKernelsTest, GradientsAreTheTransposeOfTheDifferences) {
    for (const FrameShape shape : {kMono, kColour}) {
        Linked f(shape, false);
        f.update(3);
        const auto a = random_values(shape.sites(), -1, 1, 5);
        const auto b = random_values(shape.sites(), -1, 1, 6);
        double differences = 0;
        for (std::size_t i = 0; i < shape.sites(); ++i)
            differences += f.difference(a, b, i) * static_cast<double>(f.dual[i]);
        EXPECT_NEAR(dot(a, f.gradient_now) + dot(b, f.gradient_next), differences, 1e-4);
    }
}

TEST(MotionKernelsTest, ConfidenceLimitsTheDualOverPlanes) {
    for (const FrameShape shape : {kMono, kColour}) {
        Linked free(shape, false), limited(shape, false);
        free.confidence.assign(shape.pixels(), 255);
        free.update(1e9F);
        limited.confidence[3] = 0;
        limited.update(2);
        const auto norm = [&](const Linked& f, std::size_t pixel) {
            double square = 0;
            for (std::size_t i = pixel; i < shape.sites(); i += shape.pixels())
                square += static_cast<double>(f.dual[i]) * static_cast<double>(f.dual[i]);
            return std::sqrt(square);
        };
        for (std::size_t i = 0; i < shape.pixels(); ++i)
            EXPECT_NEAR(
                norm(limited, i),
                std::min(norm(free, i), 2 * std::sqrt(0.04 / static_cast<double>(free.step[i])) *
                                            limited.confidence[i] / 255.0),
                1e-5);
        EXPECT_EQ(limited.dual[3], 0);
    }
}

TEST(MotionKernelsTest, GiveTheSameBitsOnEverySimdTarget) {
    for (const FrameShape shape : {kMono, kColour}) {
        std::vector<float> now, next;
        for_each_simd_target([&](const std::string& target) {
            Linked f(shape, false);
            f.update(2);
            if (now.empty()) {
                now = f.gradient_now;
                next = f.gradient_next;
            }
            EXPECT_EQ(f.gradient_now, now) << target;
            EXPECT_EQ(f.gradient_next, next) << target;
        });
    }
}

}  // namespace
}  // namespace stipple
