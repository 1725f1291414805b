#include "decoder/reddy2011/sparse_frames.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/flux_video.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 24, .cols = 40, .planes = 1};

FluxVideo transformed(FluxVideo frame, int levels) {
    WaveletTransform(frame.shape(), levels).forward(frame.plane(0, 0));
    return frame;
}

TEST(WaveletTest, IsOrthonormal) {
    for (const int levels : {0, 1, 2, 3}) {
        const FluxVideo a = random_video(1, kShape, 1);
        const FluxVideo b = random_video(1, kShape, 2);
        const FluxVideo wa = transformed(a, levels);
        const FluxVideo wb = transformed(b, levels);
        // Sums of 960 products of floats: relative rounding of some 1e-6.
        EXPECT_NEAR(dot(wa.data(), wb.data()), dot(a.data(), b.data()), 1e-3) << levels;
        EXPECT_NEAR(dot(wa.data(), wa.data()), dot(a.data(), a.data()), 1e-3) << levels;
    }
}

TEST(WaveletTest, TheInverseRestoresLight) {
    for (const FrameShape shape : {kShape, FrameShape{16, 16, 1}, FrameShape{8, 8, 1}}) {
        const WaveletTransform wavelet(shape, 4);
        const FluxVideo light = random_video(1, shape, 3);
        FluxVideo x = light;
        wavelet.forward(x.plane(0, 0));
        wavelet.inverse(x.plane(0, 0));
        EXPECT_LT(mean_square(x.data(), light.data()), 1e-12);
    }
}

// Four vanishing moments: polynomials up to the third degree have no details, except where the
// period ends. A line of 40 has 20 details of level 1; the last three see the end.
TEST(WaveletTest, PolynomialsHaveNoDetails) {
    FluxVideo x(1, kShape);
    for (int row = 0; row < kShape.rows; ++row)
        for (int col = 0; col < kShape.cols; ++col) {
            const float t = static_cast<float>(col) / 40;
            x.plane(0, 0)(row, col) = 1 + t - 2 * t * t + t * t * t;
        }
    const FluxVideo w = transformed(x, 1);
    for (int col = 20; col < 37; ++col) EXPECT_NEAR(w.plane(0, 0)(0, col), 0, 1e-6F);
    EXPECT_GT(std::abs(w.plane(0, 0)(0, 39)), 0.001F);
}

// Of each level a factor 2: sqrt(2) for rows and for columns.
TEST(WaveletTest, AConstantIsAllInTheLowpassCorner) {
    FluxVideo x(1, kShape);
    for (float& light : x.data()) light = 0.5F;
    FluxVideo w = transformed(x, 2);
    WaveletTransform(kShape, 2).shrink(w.plane(0, 0), 100);
    for (int row = 0; row < kShape.rows; ++row)
        for (int col = 0; col < kShape.cols; ++col)
            EXPECT_NEAR(w.plane(0, 0)(row, col), row < 6 && col < 10 ? 2 : 0, 1e-5F);
}

TEST(WaveletTest, ShrinkingIsTheSoftThreshold) {
    FluxVideo x(1, {8, 8, 1});
    for (float& value : x.data()) value = -0.3F;
    x.plane(0, 0)(7, 7) = 0.05F;
    WaveletTransform({8, 8, 1}, 1).shrink(x.plane(0, 0), 0.1F);
    EXPECT_EQ(x.plane(0, 0)(3, 3), -0.3F);
    EXPECT_NEAR(x.plane(0, 0)(3, 4), -0.2F, 1e-7F);
    EXPECT_NEAR(x.plane(0, 0)(4, 0), -0.2F, 1e-7F);
    EXPECT_EQ(x.plane(0, 0)(7, 7), 0);
}

TEST(WaveletTest, FramesArePaddedToWhatAllLevelsCanHalve) {
    EXPECT_EQ(WaveletTransform::padded_shape({45, 83, 3}, 3), (FrameShape{48, 88, 3}));
    EXPECT_EQ(WaveletTransform::padded_shape({17, 400, 1}, 9), (FrameShape{20, 400, 1}));
    EXPECT_EQ(WaveletTransform::padded_shape({1, 33, 1}, 3), (FrameShape{1, 33, 1}));
    EXPECT_EQ(WaveletTransform::padded_shape({30, 34, 3}, 3), (FrameShape{32, 40, 3}));
    for (int rows = 1; rows < 140; ++rows)
        for (int cols = rows; cols < 140; ++cols) {
            const FrameShape padded = WaveletTransform::padded_shape({rows, cols, 1}, 4);
            EXPECT_EQ(WaveletTransform::padded_shape(padded, 4), padded) << rows << ' ' << cols;
        }
    EXPECT_EQ(WaveletTransform({20, 400, 1}, 9).levels(), 2);
    EXPECT_EQ(WaveletTransform({1, 33, 1}, 3).levels(), 0);
}

}  // namespace
}  // namespace stipple
