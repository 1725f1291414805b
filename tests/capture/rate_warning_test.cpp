#include "capture/sensor_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stipple {
namespace {

using testing::HasSubstr;

/// The rate of `count` frames that came `period_ns` apart.
FrameRate rate_of(int count, std::int64_t period_ns) {
    FrameRate rate;
    for (int i = 0; i < count; ++i) {
        FrameRecord record;
        record.id = static_cast<std::uint64_t>(i);
        record.stamp_source = StampSource::kDeviceClock;
        record.device_ns = 1'000'000'000 + i * period_ns;
        rate.add(record);
    }
    return rate;
}

/// A slot of 5 ms: 200 a second.
SensorParams sensor() {
    SensorParams params;
    params.name = "s";
    params.slot_us = 5000;
    return params;
}

TEST(RateWarningTest, RatesThatAgreeWithin2PercentGiveNone) {
    for (const std::int64_t period_ns : {4'910'000, 5'000'000, 5'090'000}) {
        EXPECT_EQ(camera_rate_warning(rate_of(20, period_ns), sensor()), "");
        EXPECT_EQ(recording_rate_warning("a", rate_of(20, period_ns), sensor()), "");
    }
    EXPECT_EQ(video_rate_warning("a", 203.9, sensor()), "");
    EXPECT_EQ(exposure_warning("a", 5100, sensor()), "");
}

TEST(RateWarningTest, OtherRatesAreNamedWithTheSettingsThatCorrectThem) {
    const FrameRate rate = rate_of(20, 10'000'000);
    EXPECT_THAT(camera_rate_warning(rate, sensor()).text(),
                testing::AllOf(HasSubstr("100 frames/s"), HasSubstr("sensor.slot_us = 10000"),
                               HasSubstr("AcquisitionFrameRate = 200")));
    EXPECT_THAT(recording_rate_warning("a.strec", rate, sensor()).text(),
                testing::AllOf(HasSubstr("a.strec: "), HasSubstr("sensor.slot_us = 10000")));
    EXPECT_THAT(
        video_rate_warning("a.mp4", 50, sensor()).text(),
        testing::AllOf(HasSubstr("a.mp4: has 50 frames/s"), HasSubstr("4x as fast"),
                       HasSubstr("sensor.slot_us = 20000 keeps the speed; resample = flow makes")));
    EXPECT_THAT(video_rate_warning("a.mp4", 1000, sensor()).text(), HasSubstr("resample = blend"));
}

TEST(RateWarningTest, ALongExposureIsNamed) {
    EXPECT_THAT(exposure_warning("a.cine", 8000, sensor()),
                testing::AllOf(HasSubstr("a.cine: "), HasSubstr("8000 us"), HasSubstr("blurred")));
}

TEST(RateWarningTest, TooFewFramesGiveNone) {
    EXPECT_EQ(camera_rate_warning(rate_of(8, 10'000'000), sensor()), "");  // 7 periods
    EXPECT_NE(camera_rate_warning(rate_of(9, 10'000'000), sensor()), "");
}

}  // namespace
}  // namespace stipple
