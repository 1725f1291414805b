#include "sensor_model/sensor_params.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"

namespace stipple {
namespace {

std::string message_of(const SensorParams& params) {
    try {
        validate(params);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

// Section 5 of the paper: r = 1000, s = 2000, w = 20000, sigma = 10, 8 bits, 200 frames/s.
TEST(SensorParamsTest, DefaultsAreThePapers) {
    const SensorParams params;
    EXPECT_EQ(params.photons_per_unit, 1000);
    EXPECT_EQ(params.full_scale_e, 2000);
    EXPECT_EQ(params.full_well_e, 20000);
    EXPECT_EQ(params.read_noise_e, 10);
    EXPECT_EQ(params.bit_depth, 8);
    EXPECT_EQ(params.slot_us, 1e6 / 200);
    EXPECT_EQ(message_of(params), "accepted");
}

TEST(SensorParamsTest, NamesTheParameterAndItsRange) {
    EXPECT_EQ(message_of({.name = "mine", .bit_depth = 17}),
              "sensor \"mine\": bit_depth: 17 is outside 1 .. 16");
    EXPECT_EQ(message_of({.read_noise_e = -1}),
              "sensor \"paper\": read_noise_e: -1 is outside 0 .. 100000");
}

TEST(SensorParamsTest, RefusesWhatIsNotAPositiveFiniteNumber) {
    for (const double bad : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
        EXPECT_THROW(validate({.photons_per_unit = bad}), InputError) << bad;
        EXPECT_THROW(validate({.full_scale_e = bad}), InputError) << bad;
        EXPECT_THROW(validate({.full_well_e = bad}), InputError) << bad;
        EXPECT_THROW(validate({.slot_us = bad}), InputError) << bad;
    }
    EXPECT_NO_THROW(validate({.read_noise_e = 0}));
}

TEST(SensorParamsTest, SaturationIsThatOfTheWellOrOfTheConverterLessTheDark) {
    SensorParams params;
    EXPECT_DOUBLE_EQ(params.saturation_e(), 2000);  // the converter
    params.full_well_e = 1500;
    EXPECT_DOUBLE_EQ(params.saturation_e(), 1500);
    params.full_well_e = 20000;
    params.mode = SensorMode::kPhysical;
    params.physical.black_level_dn = 51;          // of 255: 400 of 2000 electrons
    params.physical.dark_current_e_per_s = 2000;  // 10 in a slot of 5 ms
    params.physical.temperature_c = params.physical.dark_reference_c;
    EXPECT_NEAR(params.saturation_e(), 1600 - 10, 1e-9);
}

TEST(SensorParamsTest, TemporalNoiseIsTheRootOfTheSumOfVariances) {
    const SensorParams params{
        .mode = SensorMode::kPhysical,
        .physical = {.reset_noise_e = 4, .row_noise_e = {1, 7}, .column_temporal_noise_e = 12}};
    EXPECT_DOUBLE_EQ(params.temporal_read_noise_e(), std::sqrt(100 + 16 + 25 + 144));
}

TEST(SensorParamsTest, ChargeThatWaitsHasADarkSignalWithItsNoise) {
    SensorParams params;
    params.mode = SensorMode::kPhysical;
    params.physical = {
        .temperature_c = 28, .storage_dark_current_e_per_s = 1600, .storage_wait_us = 4000};
    EXPECT_DOUBLE_EQ(params.storage_dark_e(), 2 * 1600 * 0.004);  // doubled by 8 kelvins
    EXPECT_DOUBLE_EQ(params.temporal_read_noise_e(), std::sqrt(100 + 6.4));
    EXPECT_DOUBLE_EQ(params.saturation_e(), 2000 - 6.4);
    params.slot_us *= 16;
    EXPECT_DOUBLE_EQ(params.storage_dark_e(), 2 * 1600 * 0.004) << "whatever the exposure time";
    EXPECT_EQ(params.dark_e_per_slot(), 0);
    EXPECT_NO_THROW(validate(params));
    params.physical.storage_dark_current_e_per_s = 5e5;  // 4000 e, in the mean 2000: full scale
    EXPECT_NE(message_of(params).find("storage_dark_current_e_per_s"), std::string::npos);
}

}  // namespace
}  // namespace stipple
