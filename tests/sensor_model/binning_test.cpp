#include "sensor_model/binning.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

TEST(BinningTest, TheSumOfPixelsHasTheirLightAndTheVarianceOfItsReadings) {
    const SensorParams pixel;
    for (const int n : {2, 3}) {
        const double pixels = n * n;
        const SensorParams charge = binned(pixel, n, BinningMode::kCharge);
        const SensorParams voltage = binned(pixel, n, BinningMode::kVoltage);
        for (const SensorParams& sum : {charge, voltage}) {
            EXPECT_DOUBLE_EQ(sum.electrons_per_unit(), pixels * pixel.electrons_per_unit());
            EXPECT_DOUBLE_EQ(sum.full_well_e, pixels * pixel.full_well_e);
            EXPECT_DOUBLE_EQ(sum.saturation_e(), pixels * pixel.saturation_e());
        }
        EXPECT_DOUBLE_EQ(charge.read_noise_e, pixel.read_noise_e);
        EXPECT_DOUBLE_EQ(std::pow(voltage.read_noise_e, 2),
                         pixels * std::pow(pixel.read_noise_e, 2));
    }
    EXPECT_EQ(binned(pixel, 1, BinningMode::kVoltage), pixel);
}

TEST(BinningTest, PhysicalTermsAddAsSignalsOrAsNoise) {
    SensorParams pixel{.mode = SensorMode::kPhysical};
    pixel.physical = {.dark_current_e_per_s = 100,
                      .dsnu_e = 3,
                      .prnu = 0.02,
                      .reset_noise_e = 4,
                      .row_noise_e = {1, 2},
                      .column_noise_e = 5,
                      .black_level_dn = 8,
                      .low_gain_read_noise_e = 50,
                      .dual_gain_limit_e = 1000};
    const PhysicalTerms charge = binned(pixel, 2, BinningMode::kCharge).physical;
    const PhysicalTerms voltage = binned(pixel, 2, BinningMode::kVoltage).physical;
    for (const PhysicalTerms& sum : {charge, voltage}) {
        EXPECT_DOUBLE_EQ(sum.dark_current_e_per_s, 400);
        EXPECT_DOUBLE_EQ(sum.dsnu_e, 6);   // sqrt(4 x 3^2)
        EXPECT_DOUBLE_EQ(sum.prnu, 0.01);  // of a mean of 4
        EXPECT_DOUBLE_EQ(sum.dual_gain_limit_e, 4000);
        EXPECT_DOUBLE_EQ(sum.black_level_dn, 8);
    }
    EXPECT_DOUBLE_EQ(charge.reset_noise_e, 4);
    EXPECT_DOUBLE_EQ(voltage.reset_noise_e, 8);
    EXPECT_DOUBLE_EQ(voltage.low_gain_read_noise_e, 100);
    // Two pixels of a row have the same noise, 2 x 2; those of two rows add in power.
    EXPECT_DOUBLE_EQ(voltage.row_noise_e[1], std::sqrt(2 * 16.0));
    EXPECT_DOUBLE_EQ(voltage.column_noise_e, std::sqrt(2 * 100.0));
    EXPECT_EQ(charge.row_noise_e, pixel.physical.row_noise_e);
}

TEST(BinningTest, PixelsThatDifferAreRefused) {
    const auto refusal = [](const SensorParams& params, int n) {
        return message_of<InputError>([&] { (void)binned(params, n, BinningMode::kCharge); });
    };
    SensorParams mosaic{.mode = SensorMode::kPhysical};
    mosaic.physical.cfa = ColourFilter::kRggb;
    expect_parts(refusal(mosaic, 2), {"binning", "adds equal pixels only", "cfa"});
    expect_parts(refusal({}, 0), {"binning", "0 is not 1 to 8"});
    // 9 x 9e6 electrons are beyond the range of the key.
    expect_parts(refusal({.full_well_e = 9e6}, 3), {"full_well_e", "outside"});
}

}  // namespace
}  // namespace stipple
