#include "decoder/fast/censored_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "decoder/decode_options.h"
#include "decoder/pixel_response.h"
#include "decoder/reconstruct.h"
#include "decoder/sampling_operator.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/decoder/hand_made.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

// Tables of the standard normal distribution: phi(0) / Phi(0) = sqrt(2 / pi); at 1 0.24197 /
// 0.84134, at -1 0.24197 / 0.15866. Far below, -z - 1 / z and terms of z^-3.
TEST(CensoredSamplesTest, TheRatioIsThatOfTables) {
    EXPECT_NEAR(inverse_mills_ratio(0), 0.79788, 1e-4);
    EXPECT_NEAR(inverse_mills_ratio(1), 0.28760, 1e-4);
    EXPECT_NEAR(inverse_mills_ratio(-1), 1.52514, 2e-4);
    EXPECT_NEAR(inverse_mills_ratio(-20), 20.05, 0.1);
    EXPECT_EQ(inverse_mills_ratio(9), 0);
    for (float z = -10; z < 10; z += 0.01F)
        EXPECT_GE(inverse_mills_ratio(z), inverse_mills_ratio(z + 0.01F)) << z;
}

FluxVideo one_voxel(float light) {
    FluxVideo x(1, kSite);
    x.data()[0] = light;
    return x;
}

/// One dark sample of DN 0.
Measurements dark_sample() {
    Measurements m = hand_made(1, kSite, {{.light = 0}});
    m.state[0] |= Measurements::kZero;
    return m;
}

// By symmetry the mean of what lies below the mean is sqrt(2 / pi) deviations away from it.
TEST(CensoredSamplesTest, ASampleAtHalfADnIsExpectedBelow) {
    Measurements m = dark_sample();
    CensoredSamples censored(m, paper_noise());
    const float half_dn = paper_noise().lsb_light() / 2;
    const FluxVideo x = one_voxel(half_dn);
    refresh_variances(m, paper_noise(), x.data());
    censored.expect(x.data());
    const double deviation = std::sqrt(static_cast<double>(m.variance[0]));
    EXPECT_NEAR(m.sum[0], static_cast<double>(half_dn) - 0.79788 * deviation, 1e-4 * deviation);
}

// What is far brighter than the sample says is not believed to have been far below.
TEST(CensoredSamplesTest, BesideBrightThingsASampleStaysNearHalfADn) {
    Measurements m = dark_sample();
    CensoredSamples censored(m, paper_noise());
    const FluxVideo x = one_voxel(1);
    refresh_variances(m, paper_noise(), x.data());
    censored.expect(x.data());
    EXPECT_NEAR(m.sum[0], paper_noise().lsb_light() / 2, 0.01);
}

TEST(CensoredSamplesTest, TheSumsAreRestoredAtTheEnd) {
    Measurements m = dark_sample();
    {
        CensoredSamples censored(m, paper_noise());
        const FluxVideo x = one_voxel(0);
        std::vector<float> copy = m.sum;
        censored.expect(x.data(), copy);
        EXPECT_LT(m.sum[0], 0);
        EXPECT_EQ(m.sum, copy);
    }
    EXPECT_EQ(m.sum[0], 0);
}

/// By how much a field of 0.001 in the dark is decoded too bright.
double excess(const ExposureSchedule& schedule, DecodeMethod method) {
    constexpr float kLight = 0.001F;
    FluxVideo video(32, {.rows = 48, .cols = 48, .planes = 1});
    std::ranges::fill(video.data(), kLight);
    const Recorded recorded = record(video, schedule);
    const auto x =
        decode_block(collect_measurements(recorded.header, recorded.packets, whole(video)),
                     recorded.header.calibration, {.method = method});
    double sum = 0;
    for (const float light : x->data()) sum += static_cast<double>(std::max(light, 0.0F));
    return sum / static_cast<double>(x->voxels()) - static_cast<double>(kLight);
}

// Half of the readings are cut off at DN 0. Taken for equalities they made `fast` 0.0005 too bright
// where exposures differ, and both methods 0.003 where all last one slot.
TEST(CensoredSamplesTest, DarkLightIsNotMadeBrighter) {
    const ExposureSchedule random = random_schedule(48, 48, kPaperExposureSlots, 1);
    const ExposureSchedule frames = full_schedule(1, 4);
    EXPECT_GT(excess(random, DecodeMethod::kNaive), 0.0015);
    EXPECT_GT(excess(frames, DecodeMethod::kNaive), 0.0033);
    EXPECT_NEAR(excess(random, DecodeMethod::kFast), 0, 0.00017);
    EXPECT_NEAR(excess(random, DecodeMethod::kBest), 0, 0.00002);
    EXPECT_NEAR(excess(frames, DecodeMethod::kFast), 0, 0.00062);
    EXPECT_NEAR(excess(frames, DecodeMethod::kBest), 0, 0.0001);
}

}  // namespace
}  // namespace stipple
