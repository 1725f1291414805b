#include "decoder/conventional/shahar2011.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/decoder/recordings.h"
#include "tests/support/expect_quality.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 48, .cols = 64, .planes = 1};

constexpr int kBand = 8;  ///< rows

bool is_fast(int row) {
    return row / kBand % 2 == 1;
}

/// Bands of bars that move to the right, in turn by 0.5 and by 1 pixel a slot.
FluxVideo bands(int slots) {
    FluxVideo video(slots, kShape);
    for (int slot = 0; slot < slots; ++slot)
        for (int row = 0; row < kShape.rows; ++row)
            for (int col = 0; col < kShape.cols; ++col) {
                const float speed = is_fast(row) ? 1 : 0.5F;
                const float x = static_cast<float>(col) - speed * static_cast<float>(slot);
                const float at = x - 24 * std::floor(x / 24);
                // Ramps of a pixel, as an edge within pixels.
                const float up = std::clamp(at, 0.0F, 1.0F);
                const float down = std::clamp(at - 10, 0.0F, 1.0F);
                video.plane(slot, 0)(row, col) = 0.2F + 0.5F * (up - down);
            }
    return video;
}

FluxVideo decoded(const FluxVideo& video, const ExposureSchedule& schedule, DecodeMethod method) {
    const Recorded recorded = record(video, schedule, rounding_sensor());
    return *decode_block(collect_measurements(recorded.header, recorded.packets, whole(video)),
                         recorded.header.calibration, {.method = method});
}

/// Mean square error of the fast bands, away from rims and from the ends of the clip.
double error_of_fast_bands(const FluxVideo& x, const FluxVideo& truth) {
    double sum = 0;
    int count = 0;
    for (int slot = 16; slot < 32; ++slot)
        for (int row = 0; row < kShape.rows; ++row)
            for (int col = 8; col < kShape.cols - 8 && is_fast(row); ++col, ++count) {
                const double d = static_cast<double>(x.plane(slot, 0)(row, col)) -
                                 static_cast<double>(truth.plane(slot, 0)(row, col));
                sum += d * d;
            }
    return sum / count;
}

// What moves half as fast shows what the fast one looks like in half of its exposure.
TEST(Shahar2011Test, TheBlurOfLongExposuresIsReducedWhereTheSceneRepeatsItself) {
    const FluxVideo truth = bands(48);
    const ExposureSchedule schedule = full_schedule(4, 4);
    const double interpolated =
        error_of_fast_bands(decoded(truth, schedule, DecodeMethod::kInterpolated), truth);
    const double resolved =
        error_of_fast_bands(decoded(truth, schedule, DecodeMethod::kShahar2011), truth);
    expect_quality("gain_db", gain_db(resolved, interpolated), 3);
}

TEST(Shahar2011Test, WithoutOctavesFramesAreInterpolated) {
    const FluxVideo truth = bands(24);
    const Recorded recorded = record(truth, full_schedule(4, 4));
    const auto with = [&](DecodeOptions options) {
        return *decode_block(collect_measurements(recorded.header, recorded.packets, whole(truth)),
                             recorded.header.calibration, options);
    };
    DecodeOptions options{.method = DecodeMethod::kShahar2011};
    options.shahar2011.octaves = 0;
    EXPECT_TRUE(std::ranges::equal(with(options).data(),
                                   with({.method = DecodeMethod::kInterpolated}).data()));
}

TEST(Shahar2011Test, TheFramesAreKept) {
    const FluxVideo truth = bands(24);
    const FluxVideo longer = decoded(truth, full_schedule(4, 4), DecodeMethod::kShahar2011);
    for (int slot = 0; slot < 24; slot += 4)
        for (std::size_t i = 0; i < kShape.sites(); ++i) {
            float mean = 0;
            float expected = 0;
            for (int k = 0; k < 4; ++k) {
                mean += longer.frame(slot + k)[i] / 4;
                expected += truth.frame(slot + k)[i] / 4;
            }
            ASSERT_NEAR(mean, expected, 1e-4);
        }
    const FluxVideo shorter = decoded(truth, full_schedule(1, 4), DecodeMethod::kShahar2011);
    for (int slot = 0; slot < 24; slot += 4)
        for (std::size_t i = 0; i < kShape.sites(); ++i)
            ASSERT_NEAR(shorter.frame(slot)[i], truth.frame(slot)[i], 1e-4);
}

}  // namespace
}  // namespace stipple
