#include "io/video_decoder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stipple {
namespace {

constexpr double kMillisecond = 1e-3;

TEST(FrameTimesTest, RoundedTimesOfEqualFramesAreTheirNumbers) {
    for (const double hz : {24.0, 29.97, 59.94, 240.0, 700.0}) {
        FrameTimes times(kMillisecond, hz);
        for (int i = 0; i < 1000; ++i) {
            times.add(5000 + std::llround(i / hz / kMillisecond));
            EXPECT_EQ(times.time(), i) << hz;
        }
        EXPECT_EQ(times.unequal(), "");
    }
}

TEST(FrameTimesTest, OtherTimesAreThoseOfTheTimeStamps) {
    FrameTimes times(kMillisecond, 50);
    for (const int ms : {100, 120, 130, 200}) {
        times.add(ms);
        EXPECT_DOUBLE_EQ(times.time(), (ms - 100) / 20.0);
    }
    EXPECT_EQ(times.unequal(), "0.01 to 0.07 s apart");
}

// A tick is a frame period, as in .avi: a frame that is missing is one tick.
TEST(FrameTimesTest, AMissingFrameIsSeenWhereATickIsAPeriod) {
    FrameTimes times(0.04, 25);
    for (const int tick : {0, 1, 3, 4}) {
        times.add(tick);
        EXPECT_DOUBLE_EQ(times.time(), tick);
    }
}

TEST(FrameTimesTest, WithoutATimeStampAFrameIsAPeriodAfterTheOneBefore) {
    FrameTimes times(kMillisecond, 50);
    times.add({});
    EXPECT_EQ(times.time(), 0);
    times.add(1000);
    EXPECT_EQ(times.time(), 1);
    times.add(1090);
    EXPECT_DOUBLE_EQ(times.time(), 5.5);
    times.add({});
    EXPECT_DOUBLE_EQ(times.time(), 6.5);
}

TEST(FrameTimesTest, WithoutARateTimesAreNumbers) {
    FrameTimes times(kMillisecond, {});
    for (int i = 0; i < 5; ++i) {
        times.add(i * i);
        EXPECT_EQ(times.time(), i);
    }
}

}  // namespace
}  // namespace stipple
