#include "decoder/pixel_response.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "readout/schedules/schedule_catalogue.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

/// The paper's sensor with 10 bits and a full well at 0.9 of full scale.
SensorParams with_early_well() {
    SensorParams params;
    params.bit_depth = 10;
    params.full_well_e = 0.9 * params.full_scale_e;
    return params;
}

TEST(PixelResponseTest, SaturationBeginsFiveStandardDeviationsBelowTheFullWell) {
    Calibration calibration;  // 2000 / 255 e per DN
    calibration.full_well_e = 1000;
    calibration.black_level_dn = 7;
    // 1000 e are 127.5 DN; read noise of 10 e and rounding have a standard deviation of
    // sqrt((10 / 7.843)^2 + 1 / 12) = 1.3073 DN: 7 + 127.5 - 6.536 = 127.96.
    const PixelResponse response(calibration, {});
    EXPECT_FALSE(response.saturated(127));
    EXPECT_TRUE(response.saturated(128));
}

TEST(PixelResponseTest, ASaturatedSampleIsABoundThatNoiseDoesNotLift) {
    Calibration calibration;
    calibration.full_well_e = 1000;
    const PixelResponse response(calibration, {});
    EXPECT_EQ(response.light(125, 1), response.light(200, 1));
    EXPECT_LT(response.light(125, 1), 1.0F) << "the well, in light";
    EXPECT_GT(response.light(125, 1), 0.94F);
}

// Each term of docs/calibration.md in turn: 2 e/DN, 1000 e per unit, gain 1.25, so 1.6 thousandths
// of a unit per DN.
TEST(PixelResponseTest, ACalibratedSiteHasItsOwnResponseAndNoise) {
    Calibration calibration;
    calibration.bit_depth = 12;
    calibration.black_level_dn = 64;
    calibration.gain_e_per_dn = 2;
    const SiteCalibration site{.gain = 1.25F,
                               .gain_variance = 0.0025F,
                               .offset_dn = 70,
                               .offset_variance_dn2 = 4,
                               .dark_dn_per_s = 1000,
                               .dark_variance = 10000,
                               .readout_noise_dn2 = 9 + 1.0F / 12,
                               .defect = true};
    const PixelResponse response(calibration, {}, site, 0.005);
    // 70 DN and 3 x 5 DN of dark current: 415 DN are 330 DN of light.
    EXPECT_FLOAT_EQ(response.light(415, 3), 330 * 1.6e-3F);
    // 3 DN of read noise and rounding; 15 DN = 30 e of dark signal; 2 DN of the offset; 100 DN/s of
    // the dark current, 1.5 DN in 15 ms.
    const double dn2 = 9 + 1.0 / 12 + 30.0 / 4 + 4 + 1.5 * 1.5;
    EXPECT_NEAR(static_cast<double>(response.dark_variance(415, 3)), dn2 * 1.6e-3 * 1.6e-3, 1e-9);
    // Shot noise of 1250 e per unit; 4 % of the gain: at a light of 0.5 as much as 0.0016 x 0.5.
    EXPECT_NEAR(static_cast<double>(response.variance_per_light(0.5F)), 1.0 / 1250 + 0.0016 * 0.5,
                1e-8);
    EXPECT_NEAR(static_cast<double>(response.variance_per_light(-1)), 1.0 / 1250, 1e-8);
    EXPECT_TRUE(response.defect());
}

TEST(PixelResponseTest, ASiteOfTheHeadersValuesHasTheHeadersResponse) {
    for (const Rounding rounding : {Rounding::kNearest, Rounding::kFloor}) {
        Calibration calibration;
        calibration.rounding = rounding;
        calibration.black_level_dn = 20;
        const CalibrationPixel pixel{.responsivity = 0.5, .conversion_gain = 2};
        const double read_dn = calibration.read_noise_e / calibration.gain_e_per_dn * 2;
        const SiteCalibration site{
            .offset_dn = rounding == Rounding::kFloor ? 19.5F : 20.0F,
            .readout_noise_dn2 = static_cast<float>(read_dn * read_dn + 1.0 / 12)};
        const PixelResponse nominal(calibration, pixel);
        const PixelResponse calibrated(calibration, pixel, site, 0.005);
        for (const std::uint16_t dn : std::vector<std::uint16_t>{0, 20, 100, 254, 255}) {
            EXPECT_FLOAT_EQ(calibrated.light(dn, 2), nominal.light(dn, 2)) << dn;
            EXPECT_EQ(calibrated.saturated(dn), nominal.saturated(dn)) << dn;
        }
        EXPECT_FLOAT_EQ(calibrated.dark_variance(100, 2), nominal.dark_variance(100, 2));
        EXPECT_FLOAT_EQ(calibrated.variance_per_light(1), nominal.variance_per_light(1));
    }
}

/// linear DN 100 + (DN - 100) (1 + (DN - 100) / 4000), with a variance of 9 DN^2, of 12 bits.
ResponseTable bent_table() {
    ResponseTable table;
    for (int dn = 0; dn < 4096; ++dn) {
        const auto y = static_cast<float>(dn - 100);
        table.linear_dn.push_back(y < 0 ? static_cast<float>(dn) : 100 + y * (1 + y / 4000));
        table.variance_dn2.push_back(9);
    }
    return table;
}

// 2 e/DN and 1000 e per unit: 2 thousandths of a unit per DN.
TEST(PixelResponseTest, AResponseTableIsAppliedBeforeOffsetAndGain) {
    Calibration calibration;
    calibration.bit_depth = 12;
    calibration.gain_e_per_dn = 2;
    calibration.full_well_e = 7200;
    const ResponseTable table = bent_table();
    const ResponseCurve curve(table);
    const SiteCalibration site{.gain = 1, .offset_dn = 100, .readout_noise_dn2 = 4};
    const PixelResponse response(calibration, {}, site, 0.005, &curve);
    EXPECT_FLOAT_EQ(response.light(1100, 1), 1250 * 2e-3F);
    EXPECT_FLOAT_EQ(response.light(100, 1), 0);
    // Slope 1 + 2 x 1000 / 4000: noise of 4 DN^2 counts 2.25 times. The table adds 9.
    EXPECT_NEAR(static_cast<double>(response.dark_variance(1100, 1)), (2.25 * 4 + 9) * 4e-6, 1e-10);
    EXPECT_NEAR(static_cast<double>(response.variance_per_light(2)), 1e-3, 1e-9);
    // The well of 3600 linear DN is where y (1 + y / 4000) = 3600, y = 2289.5, slope 2.145. Noise
    // is 2 x 2.145 DN there, so clipping begins at 3600 - 5 x 4.29 = 3578.6: y = 2279.5, DN 2379.5.
    EXPECT_FALSE(response.saturated(2379));
    EXPECT_TRUE(response.saturated(2380));
    EXPECT_EQ(response.light(2400, 1), response.light(4095, 1));
}

// What clips at the full well scatters around it by the read noise. Were one of these samples taken
// for exact, an exposure of 8 slots would say that the light is 1800 / 8 e and not 2900.
TEST(PixelResponseTest, NoClippedSampleCountsAsExact) {
    const SensorParams params = with_early_well();
    FluxVideo video(40, {64, 64, 1});
    std::ranges::fill(video.data(), 2.9F);
    const Measurements m = measure(video, random_schedule(64, 64, kPaperExposureSlots, 1), params);
    std::size_t samples = 0;
    for (const std::uint8_t state : m.state) {
        if ((state & Measurements::kLast) == 0) continue;
        ++samples;
        EXPECT_TRUE((state & Measurements::kSaturated) != 0);
    }
    EXPECT_GT(samples, 30000U);
}

/// A field of 1.5: exposures of one slot are exact, all longer ones are clipped.
TEST(PixelResponseTest, AFieldThatClipsLongExposuresDecodesToItsLight) {
    const SensorParams params = with_early_well();
    FluxVideo video(40, {48, 48, 1});
    std::ranges::fill(video.data(), 1.5F);
    const Recorded recorded =
        record(video, random_schedule(48, 48, kPaperExposureSlots, 1), params);
    for (const DecodeMethod method : {DecodeMethod::kFast, DecodeMethod::kBest}) {
        const auto x =
            decode_block(collect_measurements(recorded.header, recorded.packets, whole(video)),
                         recorded.header.calibration, {.method = method});
        ASSERT_TRUE(x);
        for (int slot = 8; slot < 32; ++slot)
            for (const float light : x->frame(slot)) ASSERT_NEAR(light, 1.5, 0.2 * 1.5);
    }
}

}  // namespace
}  // namespace stipple
