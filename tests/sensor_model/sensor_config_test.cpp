#include "sensor_model/sensor_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.h"
#include "tests/support/source_tree.h"

namespace stipple {
namespace {

SensorParams read(const std::vector<std::string>& overrides = {},
                  const std::string& name = "paper") {
    const auto folder = project_path("config/sensors");
    const auto file = folder / (name + ".toml");
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
                                .rounding = Rounding::kFloor,
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

TEST(SensorConfigTest, RefusesKeysOfThePhysicalModeInPaperModeByNameAndMode) {
    for (const char* key : {"dsnu_e=1", "black_level_dn=4", "row_noise_e=[1]", "device_id=3",
                            "gain_map=[1]", "quantum_efficiency=0.5"}) {
        const std::string name = std::string(key).substr(0, std::string(key).find('='));
        EXPECT_THAT(message_of(key), testing::AllOf(testing::HasSubstr(name),
                                                    testing::HasSubstr("mode = \"physical\"")));
    }
    EXPECT_THAT(message_of("mode=other"), testing::HasSubstr("physical"));
}

TEST(SensorConfigTest, ReadsTheKeysOfNoiseAndPatternsOfThePhysicalMode) {
    const PhysicalTerms expected{.quantum_efficiency = 0.5,
                                 .dark_current_e_per_s = 2,
                                 .dark_reference_c = 25,
                                 .temperature_c = 40,
                                 .dark_doubling_c = 6,
                                 .temperature_drift_c_per_s = 0.5,
                                 .storage_dark_current_e_per_s = 7,
                                 .storage_wait_us = 8,
                                 .dsnu_e = 3,
                                 .prnu = 0.01,
                                 .read_noise_spread = 0.2,
                                 .reset_noise_e = 4,
                                 .row_noise_e = {1, 2},
                                 .column_noise_e = 5,
                                 .column_temporal_noise_e = 6,
                                 .black_level_dn = 9,
                                 .inl_dn = -1,
                                 .dnl_dn = 0.25,
                                 .hot_pixel_fraction = 0.001,
                                 .hot_pixel_dark_current = 100,
                                 .dead_pixel_fraction = 0.002,
                                 .device_id = 77,
                                 .map_rows = 1,
                                 .map_cols = 2,
                                 .transmittance = {1, 0.5},
                                 .gain_map = {1, 8}};
    const SensorParams found = read({"mode=physical",
                                     "quantum_efficiency=0.5",
                                     "dark_current_e_per_s=2",
                                     "dark_reference_c=25",
                                     "temperature_c=40",
                                     "dark_doubling_c=6",
                                     "temperature_drift_c_per_s=0.5",
                                     "storage_dark_current_e_per_s=7",
                                     "storage_wait_us=8",
                                     "dsnu_e=3",
                                     "prnu=0.01",
                                     "read_noise_spread=0.2",
                                     "reset_noise_e=4",
                                     "row_noise_e=[1, 2]",
                                     "column_noise_e=5",
                                     "column_temporal_noise_e=6",
                                     "black_level_dn=9",
                                     "inl_dn=-1",
                                     "dnl_dn=0.25",
                                     "hot_pixel_fraction=0.001",
                                     "hot_pixel_dark_current=100",
                                     "dead_pixel_fraction=0.002",
                                     "device_id=77",
                                     "map_rows=1",
                                     "map_cols=2",
                                     "transmittance=[1, 0.5]",
                                     "gain_map=[1, 8]"});
    EXPECT_EQ(found.mode, SensorMode::kPhysical);
    EXPECT_EQ(found.physical, expected);
}

TEST(SensorConfigTest, ReadsTheKeysOfSharedLightAndResponseOfThePhysicalMode) {
    const PhysicalTerms expected{.crosstalk = 0.1,
                                 .blooming = 0.2,
                                 .lag = 0.3,
                                 .parasitic_light_sensitivity = 0.4,
                                 .row_skew_slots = 0.6,
                                 .response_loss = 0.05,
                                 .low_gain_read_noise_e = 7,
                                 .dual_gain_limit_e = 8};
    const SensorParams found =
        read({"mode=physical", "crosstalk=0.1", "blooming=0.2", "lag=0.3",
              "parasitic_light_sensitivity=0.4", "row_skew_slots=0.6", "response_loss=0.05",
              "low_gain_read_noise_e=7", "dual_gain_limit_e=8", "black_level_dn=0"});
    EXPECT_EQ(found.physical, expected);
}

TEST(SensorConfigTest, TakesABlackLevelOfFourStandardDeviationsInPhysicalMode) {
    // 4 sqrt(10^2 + 24^2) = 104 e at 2000 / 255 e/DN: 13.26 DN.
    EXPECT_EQ(read({"mode=physical", "dsnu_e=24"}).physical.black_level_dn, 14);
    EXPECT_EQ(read({"mode=physical", "dsnu_e=24", "gain_map=[2]"}).physical.black_level_dn, 27);
    EXPECT_EQ(read({"mode=physical", "read_noise_e=0"}).physical.black_level_dn, 0);
    EXPECT_EQ(read({"mode=physical", "dsnu_e=24", "black_level_dn=1"}).physical.black_level_dn, 1);
    EXPECT_EQ(read().physical.black_level_dn, 0);
}

TEST(SensorConfigTest, TheSensorsHaveTheirPublishedFigures) {
    const SensorParams ideal = read({}, "ideal");
    const PhysicalTerms nothing;
    EXPECT_EQ(ideal.physical, nothing);
    EXPECT_EQ(ideal.temporal_read_noise_e(), 0);
    const SensorParams ccd = read({}, "grasshopper");
    EXPECT_NEAR(1 / ccd.gain_e_per_dn(), 0.280, 1e-6);
    EXPECT_NEAR(ccd.electrons_per_unit(), 1000, 0.1);
    const SensorParams t6 = read({}, "t6");
    EXPECT_NEAR(t6.full_well_e / t6.gain_e_per_dn(), 3647, 1e-6);
    EXPECT_NEAR(t6.read_noise_e / t6.gain_e_per_dn(), 15.0, 1e-6);
    EXPECT_NEAR(t6.physical.row_noise_e[1] / t6.gain_e_per_dn(), 4.9, 1e-6);
}

TEST(SensorConfigTest, RefusesTermsThatDoNotGoTogether) {
    const auto refusal = [](std::vector<std::string> settings) {
        settings.emplace_back("mode=physical");
        try {
            static_cast<void>(read(settings));
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    EXPECT_THAT(refusal({"black_level_dn=255"}), testing::HasSubstr("leaves nothing"));
    EXPECT_THAT(refusal({"read_noise_e=1000"}), testing::HasSubstr("black_level_dn"));
    EXPECT_THAT(refusal({"inl_dn=64"}), testing::HasSubstr("fall"));
    EXPECT_THAT(refusal({"gain_map=[1, 2]"}), testing::HasSubstr("map_rows x map_cols = 1 x 1"));
    EXPECT_THAT(refusal({"hot_pixel_fraction=0.3", "dead_pixel_fraction=0.3"}),
                testing::HasSubstr("more than half"));
    EXPECT_THAT(refusal({"dark_current_e_per_s=1e9", "temperature_c=200", "dark_doubling_c=1"}),
                testing::HasSubstr("electrons in a slot"));
    EXPECT_THAT(refusal({"transmittance=[0]"}), testing::HasSubstr("transmittance"));
    EXPECT_THAT(refusal({"row_noise_e=[\"a\"]"}), testing::HasSubstr("list of numbers"));
}

}  // namespace
}  // namespace stipple
