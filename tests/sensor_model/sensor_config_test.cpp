#include "sensor_model/sensor_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.h"

namespace stipple {
namespace {

SensorParams read(const std::vector<std::string>& overrides = {}) {
    const auto file = std::filesystem::path(STIPPLE_SOURCE_DIR) / "config/sensors/paper.toml";
    Config config(file, overrides);
    const SensorParams params = read_sensor(config);
    config.reject_unknown_keys();
    return params;
}

std::string message_of(const std::string& override_text) {
    try {
        static_cast<void>(read({override_text}));
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(SensorConfigTest, ThePaperFileHoldsTheDefaultsAndNoUnknownKey) {
    EXPECT_EQ(read(), SensorParams{});
}

TEST(SensorConfigTest, ReadsEveryKey) {
    const SensorParams expected{.name = "mine",
                                .photons_per_unit = 500,
                                .full_scale_e = 1000,
                                .full_well_e = 9000,
                                .read_noise_e = 2.5,
                                .shot_noise = false,
                                .bit_depth = 12,
                                .rounding = AdcRounding::kFloor,
                                .slot_us = 1000,
                                .charge_stores = 2};
    EXPECT_EQ(read({"name=mine", "photons_per_unit=500", "full_scale_e=1000", "full_well_e=9000",
                    "read_noise_e=2.5", "shot_noise=false", "bit_depth=12", "rounding=floor",
                    "slot_us=1000", "charge_stores=2"}),
              expected);
}

TEST(SensorConfigTest, NamesTheKeyThatIsOutOfRange) {
    EXPECT_THAT(message_of("read_noise_e=-1"), testing::HasSubstr("read_noise_e"));
    EXPECT_THAT(message_of("full_well_e=0"), testing::HasSubstr("full_well_e"));
    EXPECT_THAT(message_of("bit_depth=17"), testing::HasSubstr("bit_depth"));
    EXPECT_THAT(message_of("charge_stores=3"), testing::HasSubstr("charge_stores"));
    EXPECT_THAT(message_of("rounding=up"), testing::HasSubstr("rounding"));
}

TEST(SensorConfigTest, SaysThatOnlyThePaperModeIsAvailable) {
    EXPECT_THAT(message_of("mode=physical"),
                testing::AllOf(testing::HasSubstr("mode"), testing::HasSubstr("not implemented")));
    EXPECT_THAT(message_of("mode=other"), testing::HasSubstr("physical"));
}

}  // namespace
}  // namespace stipple
