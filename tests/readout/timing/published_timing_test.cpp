// Frame rates and row times that makers publish, against the tables of config/sensors.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "readout/timing/full_readout.h"
#include "tests/readout/timing/sensor_timing.h"

namespace stipple {
namespace {

double seconds(const ReadoutTiming& timing, std::int64_t clocks) {
    return static_cast<double>(clocks) / static_cast<double>(timing.clock_hz);
}

std::int64_t frame_clocks(const ReadoutTiming& timing, int cols, int rows) {
    return full_readout(timing, {rows, cols, 1}).total;
}

double frames_hz(const ReadoutTiming& timing, int cols, int rows) {
    return 1 / seconds(timing, frame_clocks(timing, cols, rows));
}

/// A rate with the digits that were published.
struct PublishedRate {
    int cols;
    int rows;
    double hz;
    double last_digit;  ///< of the published number
};

void expect_rates(const ReadoutTiming& timing, std::initializer_list<PublishedRate> rates) {
    for (const PublishedRate& rate : rates)
        EXPECT_NEAR(frames_hz(timing, rate.cols, rate.rows), rate.hz, rate.last_digit)
            << rate.cols << " x " << rate.rows;
}

TEST(PublishedTimingTest, Lux1310IsRightToTheClock) {
    const auto with_dark_rows = sensor_timing("lux1310", {"timing.dark_rows=4"});
    EXPECT_EQ(frame_clocks(with_dark_rows, 1280, 1020), 84143);
    EXPECT_NEAR(seconds(with_dark_rows, 84143), 0.000934922222, 5e-13);
    const auto timing = sensor_timing("lux1310");
    EXPECT_NEAR(seconds(timing, frame_clocks(timing, 1280, 1020)), 931277e-9, 1e-9);
    expect_rates(timing, {{1280, 1024, 1069.6, 0.1},
                          {1280, 720, 1519.9, 0.1},
                          {1280, 512, 2134.8, 0.1},
                          {1280, 256, 4251.9, 0.1},
                          {1280, 96, 11184, 1},
                          {1024, 768, 1770.1, 0.1},
                          {800, 600, 2871.9, 0.1},
                          {640, 480, 4434.6, 0.1},
                          {640, 96, 21598, 1},
                          {336, 96, 38726, 1},
                          {320, 240, 16682, 1},
                          {192, 96, 40413, 1}});
}

TEST(PublishedTimingTest, Lux2100IsAsFastAsPublished) {
    expect_rates(sensor_timing("lux2100"), {{1920, 1080, 1000.1, 0.1},
                                            {1280, 720, 2142, 1},
                                            {640, 480, 5407, 1},
                                            {640, 96, 24046, 1}});
}

constexpr std::array kWidths{1408, 1344, 1280, 1216, 1152, 1088, 1024, 960, 896, 640, 320};

/// Frame times of windows of `rows` rows and each of those widths.
struct Line {
    int rows;
    std::array<double, kWidths.size()> ms;
};

TEST(PublishedTimingTest, Imx273IsWithinTwoMicrosecondsInAllCells) {
    constexpr std::array kLines{
        Line{1080, {5.584, 5.283, 4.981, 4.830, 4.529, 4.378, 4.076, 3.774, 3.623, 3.623, 3.623}},
        Line{1024, {5.305, 5.019, 4.732, 4.589, 4.302, 4.159, 3.872, 3.586, 3.442, 3.442, 3.442}},
        Line{960, {4.986, 4.717, 4.448, 4.313, 4.044, 3.909, 3.640, 3.370, 3.236, 3.236, 3.236}},
        Line{800, {4.189, 3.963, 3.737, 3.623, 3.397, 3.284, 3.058, 2.832, 2.718, 2.718, 2.718}},
        Line{512, {2.754, 2.605, 2.457, 2.382, 2.234, 2.159, 2.011, 1.862, 1.788, 1.788, 1.788}},
        Line{256, {1.478, 1.399, 1.319, 1.279, 1.199, 1.159, 1.080, 1.000, 0.960, 0.960, 0.960}},
        Line{128, {0.840, 0.795, 0.750, 0.727, 0.682, 0.659, 0.614, 0.569, 0.546, 0.546, 0.546}}};
    const auto timing = sensor_timing("imx273");
    for (const Line& line : kLines)
        for (std::size_t i = 0; i < kWidths.size(); ++i)
            EXPECT_NEAR(1e3 * seconds(timing, frame_clocks(timing, kWidths[i], line.rows)),
                        line.ms[i], 0.002)
                << kWidths[i] << " x " << line.rows;
}

TEST(PublishedTimingTest, CamerasOfFullRowsAreNoFasterWithFewerColumns) {
    const auto sp5000 = sensor_timing("sp5000");
    EXPECT_NEAR(frames_hz(sp5000, 2560, 1500), 437.86, 0.01);
    const auto imx296 = sensor_timing("imx296");
    EXPECT_NEAR(frames_hz(imx296, 1440, 1088), 60.38, 0.01);
    for (const int rows : {1, 100, 1088})
        EXPECT_NEAR(frames_hz(imx296, 720, rows), 67500.0 / (rows + 30), 1e-6);
    const auto cmv4000 = sensor_timing("cmv4000");
    for (const int cols : {2048, 512, 8}) {
        const auto readout = full_readout(cmv4000, {2048, cols, 1});
        EXPECT_EQ(readout.row, 258);
        EXPECT_NEAR(1e6 * seconds(cmv4000, readout.row), 5.375, 1e-9);
    }
    EXPECT_EQ(full_readout(sp5000, {1500, 320, 1}).row, 130);
}

// 6.32 and 2.45 us are quoted for the class, rounded: (1280 + 8) / 4 + 70 = 392 clocks of 1/62 us
// are 6.3226 us, 152 clocks are 2.4516 us.
TEST(PublishedTimingTest, RowsOfVitaTakeThePublishedTime) {
    const auto four_outputs = sensor_timing("vita");
    EXPECT_EQ(full_readout(four_outputs, {1024, 1280, 1}).row, (1280 + 8) / 4 + 70);
    EXPECT_NEAR(1e6 * seconds(four_outputs, 392), 6.32, 0.005);
    EXPECT_EQ(full_readout(four_outputs, {1024, 320, 1}).row, (320 + 8) / 4 + 70);
    EXPECT_NEAR(1e6 * seconds(four_outputs, 152), 2.45, 0.005);
    const auto eight = sensor_timing("vita", {"timing.channels=8", "timing.io_clocks=1"});
    EXPECT_EQ(full_readout(eight, {1024, 1280, 1}).row, (1280 + 8) / 8 + 70);
}

TEST(PublishedTimingTest, RowsOfPlC720TakeThePublishedTime) {
    const auto timing = sensor_timing("plc720");
    for (const int cols : {1280, 640, 8})
        EXPECT_NEAR(1e6 * seconds(timing, full_readout(timing, {1024, cols, 1}).row),
                    cols * 0.01 + 2.6784, 1e-9);
    EXPECT_NEAR(1e6 * seconds(timing, full_readout(timing, {1024, 1280, 1}).row), 15.4784, 1e-9);
}

// docs/readout_timing.md: the gain in row rate when a quarter of the columns is read.
TEST(PublishedTimingTest, AQuarterOfTheColumnsGainsWhatTheRowTimeLawAllows) {
    struct Gain {
        const char* sensor;
        std::int64_t full_row;
        std::int64_t quarter_row;
        double ratio;
    };
    for (const Gain& gain : {Gain{"lux1310", 82, 22, 3.73}, Gain{"lux2100", 69, 28, 2.46},
                             Gain{"vita", 392, 152, 2.58}, Gain{"imx273", 370, 240, 1.54},
                             Gain{"imx296", 1100, 1100, 1}, Gain{"cmv4000", 258, 258, 1}}) {
        const auto timing = sensor_timing(gain.sensor);
        const FrameShape shape{timing.rows, timing.cols, 1};
        EXPECT_EQ(full_readout(timing, shape).row, gain.full_row) << gain.sensor;
        EXPECT_EQ(balanced_readout(timing, shape, 0.25).row, gain.quarter_row) << gain.sensor;
        EXPECT_NEAR(static_cast<double>(gain.full_row) / static_cast<double>(gain.quarter_row),
                    gain.ratio, 0.005);
    }
    // 4 exposures in 15 slots: 1280 / 16 x 4 / 15 = 21.3 columns a channel, 21 in some rows and 22
    // in others.
    const auto lux = sensor_timing("lux1310");
    EXPECT_NEAR(balanced_readout(lux, {1024, 1280, 1}, 4.0 / 15).row, 80 * 4.0 / 15 + 2, 1e-9);
    // Dark rows are read in full; 93 clocks and a conversion of 19 + 3 come first.
    const auto dark = sensor_timing("lux1310", {"timing.dark_rows=4"});
    EXPECT_EQ(balanced_readout(dark, {1024, 1280, 1}, 0.25).total, 93 + 22 + 4 * 82 + 1024 * 22);
}

}  // namespace
}  // namespace stipple
