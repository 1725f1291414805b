#include "io/hdr_signal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace stipple {
namespace {

using Words = std::vector<std::uint16_t>;

/// SMPTE ST 2084, in the numbers of its table.
double pq(double cd) {
    const double y = std::pow(cd / 10000, 2610.0 / 16384);
    const double c1 = 3424.0 / 4096, c2 = 2413.0 / 128, c3 = 2392.0 / 128;
    return std::pow((c1 + c2 * y) / (1 + c3 * y), 2523.0 / 32);
}

Words convert(HdrSignal& signal, const std::vector<float>& frame) {
    Words pixels(frame.size());
    signal.convert(frame, pixels);
    return pixels;
}

VideoCoding coding(VideoCurve curve, double cd_per_unit, double peak_cd = 1000) {
    VideoCoding coding;
    coding.curve = curve;
    coding.cd_per_unit = cd_per_unit;
    coding.peak_cd = peak_cd;
    return coding;
}

TEST(HdrSignalTest, PqIsTheLuminanceOfTheDisplay) {
    HdrSignal signal({1, 3, 1}, coding(VideoCurve::kPq, 100));
    const Words pixels = convert(signal, {0, 1, 5});
    EXPECT_NEAR(pixels[0], 65535 * pq(0), 1);
    EXPECT_NEAR(pixels[1], 65535 * pq(100), 1);
    EXPECT_NEAR(pixels[2], 65535 * pq(500), 1);
    EXPECT_EQ(signal.levels().clipped_fraction, 0);
}

// BT.2408-4: diffuse white has the signal 75 % in HLG.
TEST(HdrSignalTest, HlgShowsDiffuseWhiteAtThreeQuarters) {
    HdrSignal signal({1, 1, 1}, coding(VideoCurve::kHlg, 203));
    EXPECT_NEAR(convert(signal, {1})[0], 0.75 * 65535, 0.001 * 65535);
}

TEST(HdrSignalTest, GreyStaysGreyAndColoursAreInterleaved) {
    HdrSignal signal({1, 2, 3}, coding(VideoCurve::kPq, 100));
    const Words pixels = convert(signal, {1, 1, 1, 0, 1, 0});  // white, red
    for (int plane = 0; plane < 3; ++plane)
        EXPECT_NEAR(pixels[static_cast<std::size_t>(plane)], 65535 * pq(100), 9);
    // The primary R of BT.709 in BT.2020 (BT.2087-0): 0.6274, 0.0691, 0.0164.
    EXPECT_NEAR(pixels[3], 65535 * pq(62.74), 9);
    EXPECT_NEAR(pixels[4], 65535 * pq(6.91), 30);
    EXPECT_NEAR(pixels[5], 65535 * pq(1.64), 30);
}

TEST(HdrSignalTest, NothingAndLessAreBlack) {
    HdrSignal signal({1, 2, 1}, coding(VideoCurve::kPq, 100));
    const Words pixels = convert(signal, {-1, std::numeric_limits<float>::quiet_NaN()});
    EXPECT_EQ(pixels[0], pixels[1]);
    EXPECT_NEAR(pixels[0], 65535 * pq(0), 1);
}

TEST(HdrSignalTest, LevelsAreThoseOfAllFrames) {
    HdrSignal signal({1, 2, 1}, coding(VideoCurve::kPq, 100, 400));
    convert(signal, {1, 2});  // 100 and 200 cd/m2
    convert(signal, {0, 5});  // 0, and 500 clipped to 400
    const LightLevels levels = signal.levels();
    EXPECT_NEAR(levels.max_cll, 400, 1e-3);
    EXPECT_NEAR(levels.max_fall, 200, 1e-3);
    EXPECT_NEAR(levels.clipped_fraction, 0.25, 1e-9);
}

}  // namespace
}  // namespace stipple
