#include "decoder/fast/gradient_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/decoder/recordings.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

constexpr FrameShape kMono{.rows = 7, .cols = 41, .planes = 1};
constexpr FrameShape kColour{.rows = 6, .cols = 19, .planes = 3};
constexpr float kNoLimit = 1e9F;

struct Frame {
    explicit Frame(FrameShape frame_shape)
        : shape(frame_shape),
          step(random_values(shape.pixels(), 0.01F, 0.1F, 1)),
          x(random_values(shape.sites(), 0, 1, 2)),
          next(random_values(shape.sites(), 0, 1, 3)),
          dual_col(shape.sites()),
          dual_row(shape.sites()),
          gradient(shape.sites()) {}

    [[nodiscard]] DualStep dual_step(float weight) const {
        return {.step = step.data(), .coupling = 12, .weight = weight, .reference_step = 0.04F};
    }
    /// The largest norm that the dual of a pixel may have.
    [[nodiscard]] double most(double weight, std::size_t pixel) const {
        return weight * std::sqrt(0.04 / static_cast<double>(step[pixel]));
    }
    void update_spatial(float weight) {
        update_spatial_dual(shape, dual_step(weight), x.data(), {dual_col.data(), dual_row.data()},
                            gradient.data());
    }
    void update_static(float weight) {
        update_static_dual(shape, dual_step(weight), {x.data(), next.data()}, dual_col.data(),
                           gradient.data());
    }
    /// The Euclidean norm of the duals of a pixel.
    [[nodiscard]] double norm(std::size_t pixel) const {
        double square = 0;
        for (std::size_t i = pixel; i < shape.sites(); i += shape.pixels())
            square += static_cast<double>(dual_col[i]) * static_cast<double>(dual_col[i]) +
                      static_cast<double>(dual_row[i]) * static_cast<double>(dual_row[i]);
        return std::sqrt(square);
    }

    FrameShape shape;
    std::vector<float> step, x, next, dual_col, dual_row, gradient;
};

TEST(GradientKernelsTest, DualsAscendAlongForwardDifferences) {
    for (const FrameShape shape : {kMono, kColour}) {
        Frame f(shape);
        f.update_spatial(kNoLimit);
        const auto cols = static_cast<std::size_t>(shape.cols);
        for (std::size_t i = 0; i < shape.sites(); ++i) {
            const std::size_t pixel = i % shape.pixels();
            const bool last_col = i % cols == cols - 1;
            const bool last_row = pixel >= shape.pixels() - cols;
            const float sigma = 1 / (12 * f.step[pixel]);
            EXPECT_NEAR(f.dual_col[i], last_col ? 0 : sigma * (f.x[i + 1] - f.x[i]), 1e-5);
            EXPECT_NEAR(f.dual_row[i], last_row ? 0 : sigma * (f.x[i + cols] - f.x[i]), 1e-5);
        }
    }
}

/// <grad x, dual> = <x, grad^T dual>, for the dual of another x.
TEST(GradientKernelsTest, GradientIsTheTransposeOfTheDifferences) {
    for (const FrameShape shape : {kMono, kColour}) {
        Frame f(shape);
        f.update_spatial(kNoLimit);
        const auto cols = static_cast<std::size_t>(shape.cols);
        double differences = 0;
        const auto z = random_values(shape.sites(), -1, 1, 9);
        for (std::size_t i = 0; i < shape.sites(); ++i) {
            if (i % cols < cols - 1)
                differences += (static_cast<double>(z[i + 1]) - static_cast<double>(z[i])) *
                               static_cast<double>(f.dual_col[i]);
            if (i % shape.pixels() < shape.pixels() - cols)
                differences += (static_cast<double>(z[i + cols]) - static_cast<double>(z[i])) *
                               static_cast<double>(f.dual_row[i]);
        }
        EXPECT_NEAR(dot(z, f.gradient), differences, 1e-4);  // 300 sums of floats up to 20
    }
}

TEST(GradientKernelsTest, DualsAreProjectedToTheirWeightOverDirectionsAndPlanes) {
    for (const FrameShape shape : {kMono, kColour}) {
        Frame free(shape), limited(shape);
        free.update_spatial(kNoLimit);
        limited.update_spatial(2);
        std::size_t shrunk = 0;
        for (std::size_t pixel = 0; pixel < shape.pixels(); ++pixel) {
            EXPECT_NEAR(limited.norm(pixel), std::min(free.norm(pixel), free.most(2, pixel)), 1e-5);
            shrunk += free.norm(pixel) > free.most(2, pixel);
        }
        EXPECT_GT(shrunk, 10U);
        EXPECT_LT(shrunk, shape.pixels());
    }
}

TEST(GradientKernelsTest, StaticDualsAscendAlongDifferencesInTime) {
    for (const FrameShape shape : {kMono, kColour}) {
        Frame free(shape), limited(shape);
        free.update_static(kNoLimit);
        limited.update_static(1);
        for (std::size_t i = 0; i < shape.sites(); ++i) {
            const std::size_t pixel = i % shape.pixels();
            EXPECT_NEAR(free.dual_col[i], (free.next[i] - free.x[i]) / (12 * free.step[pixel]),
                        1e-5);
            EXPECT_EQ(free.gradient[i], -free.dual_col[i]);
            EXPECT_NEAR(limited.norm(pixel), std::min(free.norm(pixel), free.most(1, pixel)), 1e-5);
        }
    }
}

TEST(GradientKernelsTest, GiveTheSameBitsOnEverySimdTarget) {
    std::vector<float> first;
    for_each_simd_target([&](const std::string& target) {
        Frame f(kColour);
        f.update_spatial(2);
        f.update_static(1);
        if (first.empty()) first = f.gradient;
        EXPECT_EQ(f.gradient, first) << target;
    });
}

}  // namespace
}  // namespace stipple
