#include "decoder/pixel_response.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "decoder/decode_options.h"
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
