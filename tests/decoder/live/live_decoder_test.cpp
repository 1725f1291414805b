#include "decoder/live/live_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "readout/schedules/random_codes.h"
#include "tests/decoder/hand_made.h"
#include "tests/decoder/recordings.h"
#include "tests/support/expect_quality.h"

namespace stipple {
namespace {

constexpr int kSlots = 40;

ExposureSchedule paper_schedule(FrameShape shape) {
    return random_schedule(shape.rows, shape.cols, kPaperExposureSlots, 1);
}

/// Samples without noise and rounding.
Measurements exact(const FluxVideo& video) {
    Measurements m = measure(video, paper_schedule(video.shape()), rounding_sensor());
    const std::size_t sites = m.shape.sites();
    for (std::size_t site = 0; site < sites; ++site) {
        float sum = 0;
        for (std::size_t i = site; i < m.voxels(); i += sites) {
            if ((m.state[i] & Measurements::kFirst) != 0) sum = 0;
            sum += video.data()[i];
            if ((m.state[i] & Measurements::kLast) != 0) m.sum[i] = sum;
        }
    }
    return m;
}

FluxVideo live(const Measurements& m) {
    return *decode_live(m);
}

/// Light that does not change, from pixel to pixel between 0.05 and 0.2.
FluxVideo still_texture(FrameShape shape) {
    FluxVideo video(kSlots, shape);
    for (int slot = 0; slot < kSlots; ++slot)
        std::ranges::copy(random_values(shape.sites(), 0.05F, 0.2F, 4), video.frame(slot).begin());
    return video;
}

/// A bright stripe that moves by two pixels a slot.
FluxVideo moving_stripe(FrameShape shape) {
    FluxVideo video(kSlots, shape);
    for (int slot = 0; slot < kSlots; ++slot)
        for (std::size_t i = 0; i < shape.sites(); ++i) {
            const int col = static_cast<int>(i) % shape.cols;
            video.frame(slot)[i] = (col - 2 * slot + 4 * shape.cols) % 30 < 12 ? 0.2F : 0.05F;
        }
    return video;
}

/// Mean square error without the first and last 8 slots.
double error_of(const FluxVideo& x, const FluxVideo& video) {
    const std::size_t margin = 8 * video.shape().sites();
    const std::size_t count = video.voxels() - 2 * margin;
    return mean_square(x.data().subspan(margin, count), video.data().subspan(margin, count));
}

TEST(LiveDecoderTest, ConstantLightComesBack) {
    for (const FrameShape shape : {FrameShape{.rows = 20, .cols = 30, .planes = 3},
                                   FrameShape{.rows = 1, .cols = 1, .planes = 1},
                                   FrameShape{.rows = 3, .cols = 2, .planes = 1}}) {
        const FluxVideo video = flat_video(kSlots, shape, 0.3F);
        // Rounding of sums of some 24 numbers.
        const FluxVideo x = live(exact(video));
        for (const float light : x.data()) ASSERT_NEAR(light, 0.3F, 3e-7F);
    }
}

TEST(LiveDecoderTest, AStillSceneIsBetterThanItsNearestSamples) {
    const FluxVideo video = still_texture({.rows = 48, .cols = 48, .planes = 1});
    const Measurements m = measure(video, paper_schedule(video.shape()));
    EXPECT_GT(gain_db(error_of(live(m), video), error_of(nearest_samples(m), video)), 2);
}

TEST(LiveDecoderTest, AMovingEdgeIsTwoDecibelsBetterThanItsNearestSamples) {
    const FluxVideo video = moving_stripe({.rows = 48, .cols = 60, .planes = 1});
    const Measurements m = measure(video, paper_schedule(video.shape()));
    EXPECT_GT(gain_db(error_of(live(m), video), error_of(nearest_samples(m), video)), 2);
}

TEST(LiveDecoderTest, ASlotDependsOnNoSampleAfterSixteenMore) {
    const FluxVideo video = moving_stripe({.rows = 12, .cols = 30, .planes = 1});
    const Measurements m = measure(video, paper_schedule(video.shape()));
    const FluxVideo x = live(m);
    for (const int slot : {7, 8, 12, 16}) {
        Measurements later = m;
        const std::size_t after = static_cast<std::size_t>(slot + 16) * m.shape.sites();
        for (std::size_t i = after; i < m.voxels(); ++i) later.sum[i] *= 1.5F;
        const FluxVideo y = live(later);
        for (int same = 0; same <= slot; ++same)
            EXPECT_TRUE(std::ranges::equal(x.frame(same), y.frame(same))) << slot << ' ' << same;
        EXPECT_FALSE(std::ranges::equal(x.frame(slot + 16), y.frame(slot + 16)));
    }
}

TEST(LiveDecoderTest, GivesTheSameBitsForAnyNumberOfThreads) {
    const FluxVideo video = random_video(kSlots, {.rows = 33, .cols = 45, .planes = 3}, 3);
    const Measurements m = measure(video, paper_schedule(video.shape()));
    const ThreadLimit one(1);
    const FluxVideo x = live(m);
    for (const int threads : {2, 4}) {
        const ThreadLimit several(threads);
        EXPECT_TRUE(std::ranges::equal(live(m).data(), x.data())) << threads;
    }
}

TEST(LiveDecoderTest, SaturatedSamplesAreBounds) {
    // At light 0.6 exposures of 4 and 8 slots are saturated, at light 3 all are, with bounds 2.
    const FrameShape shape{.rows = 16, .cols = 16, .planes = 1};
    const SensorParams sensor{.read_noise_e = 0, .shot_noise = false};
    const FluxVideo bright = flat_video(kSlots, shape, 0.6F);
    const FluxVideo lit = live(measure(bright, paper_schedule(shape), sensor));
    for (const float light : lit.data()) ASSERT_NEAR(light, 0.6F, 0.004F);  // half a DN
    const FluxVideo glare = flat_video(kSlots, shape, 3);
    const FluxVideo x = live(measure(glare, paper_schedule(shape), sensor));
    for (int slot = 8; slot < kSlots - 8; ++slot)
        for (const float light : x.frame(slot)) ASSERT_NEAR(light, 2, 0.02);
}

TEST(LiveDecoderTest, WhatNoSampleOfAWindowTellsIsThatOfTheNearestSamples) {
    // 26 slots are longer than a window; the other pixel has samples at the ends alone.
    const FrameShape shape{.rows = 1, .cols = 2, .planes = 1};
    const Measurements m =
        hand_made(64, shape,
                  {{.site = 0, .first_slot = 3, .open_slots = 0x3FFFFFF, .light = 2.6F},
                   {.site = 1, .first_slot = 0, .open_slots = 1, .light = 0.2F},
                   {.site = 1, .first_slot = 63, .open_slots = 1, .light = 0.4F}});
    const FluxVideo x = live(m);
    const FluxVideo nearest = nearest_samples(m);
    for (int slot = 0; slot < 64; ++slot)
        EXPECT_EQ(x.frame(slot)[0], nearest.frame(slot)[0]) << slot;
    EXPECT_EQ(x.frame(30)[1], nearest.frame(30)[1]);
}

TEST(LiveDecoderTest, TwoBucketsTellOfTheSameLight) {
    const FluxVideo video = flat_video(24, {.rows = 1, .cols = 1, .planes = 1}, 0.3F);
    const ExposureSchedule two_buckets(1, 1, 8, {0, 2}, {{0, 0b1010101}, {1, 0b1010101}});
    const FluxVideo x = live(measure(video, two_buckets, {.read_noise_e = 0, .shot_noise = false}));
    for (const float light : x.data()) EXPECT_NEAR(light, 0.3F, 0.002F);  // half a DN in four slots
}

TEST(LiveDecoderTest, AMosaicInMotionIsBetterThanItsNearestSamples) {
    const FluxVideo video = moving_stripe({.rows = 48, .cols = 60, .planes = 3});
    const Recorded recorded =
        record_mosaic(video, ColourFilter::kRggb, paper_schedule({48, 60, 1}));
    const Measurements m = collect_measurements(recorded.header, recorded.packets, whole(video));
    EXPECT_GT(gain_db(error_of(live(m), video), error_of(nearest_samples(m), video)), 0.5);
}

TEST(LiveDecoderTest, StopsWhenProgressSaysSo) {
    const Measurements m = exact(flat_video(kSlots, kSite, 0.3F));
    EXPECT_FALSE(decode_live(m, [](double done) { return done < 0.5; }).has_value());
}

}  // namespace
}  // namespace stipple
