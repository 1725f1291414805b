#include "capture/sensor_warnings.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

SensorParams sensor_of_12_bits(double black_dn) {
    SensorParams sensor{.name = "mine", .bit_depth = 12, .mode = SensorMode::kPhysical};
    sensor.physical.black_level_dn = black_dn;
    return sensor;
}

SourceInfo footage(double black_dn, double white_dn) {
    return {.bits = 16, .black_dn = black_dn, .white_dn = white_dn};
}

TEST(LevelWarningTest, NamesBothLevelsAndTheKey) {
    EXPECT_EQ(black_level_warning("a.dng", footage(168, 4095), sensor_of_12_bits(64)).text(),
              "a.dng: its black level is 168 DN, that of sensor \"mine\" 64 DN, both of 12 bits: "
              "light is right, but if the sensor stands for this camera, use "
              "sensor.black_level_dn = 168");
}

TEST(LevelWarningTest, ADnIsNoDifference) {
    for (const double black_dn : {63.0, 64.0, 65.0})
        EXPECT_EQ(black_level_warning("a.cine", footage(black_dn, 4064), sensor_of_12_bits(64)),
                  "");
    EXPECT_NE(black_level_warning("a.cine", footage(65.5, 4064), sensor_of_12_bits(64)), "");
}

TEST(LevelWarningTest, OtherBitsDoNotCompare) {
    EXPECT_EQ(black_level_warning("a.dng", footage(16, 1023), sensor_of_12_bits(64)), "");
    EXPECT_EQ(black_level_warning("a.dng", footage(1024, 65535), sensor_of_12_bits(64)), "");
}

TEST(LevelWarningTest, WithoutALevelThereIsNothingToCompare) {
    EXPECT_EQ(black_level_warning("a.png", {.bits = 12}, sensor_of_12_bits(64)), "");
    SensorParams paper = sensor_of_12_bits(0);
    paper.mode = SensorMode::kPaper;
    EXPECT_EQ(black_level_warning("a.dng", footage(168, 4095), paper), "");
}

}  // namespace
}  // namespace stipple
