#include "capture/frame_sequence.h"

#include <gtest/gtest.h>

#include <limits>

namespace stipple {
namespace {

FrameRecord frame(std::uint64_t id, std::int64_t device_ms, std::uint32_t epoch = 0) {
    FrameRecord record;
    record.id = id;
    record.epoch = epoch;
    record.stamp_source = StampSource::kDeviceClock;
    record.device_ns = device_ms * 1'000'000;
    record.host_monotonic_ns = record.device_ns + static_cast<std::int64_t>(id % 3) * 700'000;
    return record;
}

TEST(FrameRateTest, IsPeriodsOverTheTimeBetweenTheirStamps) {
    FrameRate rate;
    EXPECT_FALSE(rate.hz());
    rate.add(frame(7, 100));
    EXPECT_FALSE(rate.hz());  // a single frame has no period
    rate.add(frame(8, 105));
    EXPECT_DOUBLE_EQ(rate.hz().value(), 200);
    rate.add(frame(17, 150));  // 8 were lost
    EXPECT_EQ(rate.periods(), 10U);
    EXPECT_DOUBLE_EQ(rate.hz().value(), 200);
}

TEST(FrameRateTest, BeginsAnewAfterAnOutage) {
    FrameRate rate;
    rate.add(frame(0, 0));
    rate.add(frame(1, 5));
    rate.add(frame(2, 60'000, 1));
    EXPECT_FALSE(rate.hz());
    rate.add(frame(4, 60'040, 1));
    EXPECT_DOUBLE_EQ(rate.hz().value(), 50);
}

TEST(FrameRateTest, BeginsAnewWhereAClockOrANumberGoesBack) {
    FrameRate rate;
    rate.add(frame(10, 9'000));
    rate.add(frame(11, 9'005));
    rate.add(frame(12, 3));  // the clock of the camera was set to 0
    EXPECT_FALSE(rate.hz());
    rate.add(frame(13, 8));
    EXPECT_DOUBLE_EQ(rate.hz().value(), 200);
    rate.add(frame(2, 13));
    EXPECT_FALSE(rate.hz());
    EXPECT_EQ(rate.periods(), 0U);
}

TEST(FrameRateTest, StampsMayBeAnyNumbers) {
    FrameRate rate;
    FrameRecord first = frame(0, 0);
    first.device_ns = std::numeric_limits<std::int64_t>::min();
    FrameRecord second = frame(1, 0);
    second.device_ns = std::numeric_limits<std::int64_t>::max();
    rate.add(first);
    rate.add(second);
    EXPECT_DOUBLE_EQ(rate.seconds(), 18446744073.709551615);
    rate.add(first);
    EXPECT_FALSE(rate.hz());
}

TEST(FrameRateTest, GoesByArrivalWhereTheDeviceGivesNoStamp) {
    FrameRate rate;
    for (std::uint64_t id = 0; id < 4; ++id) {
        FrameRecord record = frame(id, static_cast<std::int64_t>(id) * 10);
        record.stamp_source = StampSource::kNone;
        record.device_ns = 0;
        rate.add(record);
    }
    EXPECT_DOUBLE_EQ(rate.hz().value(), 100);  // 3 periods in 30 ms, frames 0 and 3 come alike
}

}  // namespace
}  // namespace stipple
