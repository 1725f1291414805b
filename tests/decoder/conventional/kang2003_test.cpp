#include "decoder/conventional/kang2003.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "readout/schedules/tiled_schedule.h"
#include "stream/stream_writer.h"
#include "tests/decoder/conventional/noisy_frames.h"
#include "tests/decoder/recordings.h"
#include "tests/stream/stream_bytes.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 48, .cols = 64, .planes = 1};
constexpr int kShortSlot = 5;

/// That of config/schedules: 4 slots, and 1 slot of the next 4.
ExposureSchedule alternating() {
    return {1, 1, 8, {0, 2}, {{0, 0b1111}, {kShortSlot, 1}}};
}

/// 7 slots, then 1.
ExposureSchedule dol() {
    return {1, 1, 8, {0, 2}, {{0, 0b1111111}, {7, 1}}};
}

FluxVideo decoded(const Recorded& recorded, const FluxVideo& video,
                  DecodeMethod method = DecodeMethod::kKang2003) {
    return *decode_block(collect_measurements(recorded.header, recorded.packets, whole(video)),
                         recorded.header.calibration, {.method = method});
}

/// Of light per slot, of an exposure of n slots: that of Eq. 1, and q^2 / 12 of rounding.
double variance(double light, double n) {
    const double dn_e = 2000.0 / 255;
    return (1000 * n * light + 100 + dn_e * dn_e / 12) / (1e6 * n * n);
}

/// Mean square error of the short frames but the first and the last.
double short_error(const FluxVideo& x, const FluxVideo& truth) {
    double sum = 0;
    int frames = 0;
    for (int slot = 8 + kShortSlot; slot < truth.slots() - 8; slot += 8, ++frames)
        sum += error_of(x, truth, slot);
    return sum / frames;
}

// 5 frames of 32 x 48 pixels: 2 standard deviations are 3.2 % of the variance.
TEST(Kang2003Test, BeyondTheLongExposureTheNoiseIsThatOfTheShortOne) {
    const FluxVideo video = flat_video(56, kShape, 1.2F);  // 4 slots saturate at 0.5
    const FluxVideo x = decoded(record(video, alternating()), video);
    EXPECT_NEAR(short_error(x, video) / variance(1.2, 1), 1, 0.05);
    // Between them it is less: a mean of two frames, or of pixels along motion that is noise.
    for (int slot = 8; slot < 48; ++slot)
        EXPECT_LT(error_of(x, video, slot), 1.1 * variance(1.2, 1)) << slot;
}

// The short sample has the weight 1 / Var(S), the long ones before and after it 1 / Var(L) each: a
// texture of light 0.05 to 0.45 that rests. Motion that is noise averages more pixels of these.
TEST(Kang2003Test, BelowSaturationTheSamplesAreMergedByTheirVariance) {
    FluxVideo video = moving_texture(56, kShape, 0);
    for (float& light : video.data()) light *= 0.5F;
    const FluxVideo x = decoded(record(video, alternating()), video);
    double merged = 0;
    for (const float light : video.frame(0)) {
        const auto l = static_cast<double>(light);
        merged +=
            1 / (1 / variance(l, 1) + 2 / variance(l, 4)) / static_cast<double>(kShape.sites());
    }
    EXPECT_NEAR(short_error(x, video) / merged, 1, 0.2);
}

// Light of 0.16 to 1.44. No frame of 4 slots measures the brighter half; its bound is 0.5.
TEST(Kang2003Test, ATranslatingSceneIsRecoveredBeyondTheLongExposure) {
    FluxVideo video = moving_texture(56, kShape, 0.5F);
    for (float& light : video.data()) light *= 1.6F;
    for (const ExposureSchedule& schedule : {alternating(), dol()}) {
        const Recorded recorded = record(video, schedule);
        const FluxVideo x = decoded(recorded, video);
        const FluxVideo held = decoded(recorded, video, DecodeMethod::kNaive);
        const FluxVideo full4x =
            decoded(record(video, full_schedule(4, 4)), video, DecodeMethod::kInterpolated);
        for (int slot = 12; slot < 44; ++slot) {
            EXPECT_LT(error_of(x, video, slot), 2 * variance(0.8, 1)) << slot;
            EXPECT_LT(error_of(x, video, slot), error_of(full4x, video, slot) / 10) << slot;
        }
        EXPECT_LT(error_of(x, video, 25), error_of(held, video, 25) / 2);
    }
}

TEST(Kang2003Test, WhatIsSaturatedInAllFramesIsAsBrightAsTheShortOneTells) {
    FluxVideo video = flat_video(40, kShape, 0.3F);
    for (int slot = 0; slot < video.slots(); ++slot)
        for (int row = 8; row < 24; ++row)
            for (int col = 8; col < 24; ++col) video.plane(slot, 0)(row, col) = 9;
    for (const ExposureSchedule& schedule : {alternating(), dol()}) {
        const FluxVideo x = decoded(record(video, schedule), video);
        for (int slot = 8; slot < 32; ++slot) {
            for (int row = 8; row < 24; ++row)
                for (int col = 8; col < 24; ++col)
                    ASSERT_NEAR(x.plane(slot, 0)(row, col), 2, 0.1) << slot;
            ASSERT_NEAR(x.plane(slot, 0)(36, 40), 0.3, 0.1) << slot;
        }
    }
}

TEST(Kang2003Test, WithoutNoiseAStaticSceneIsReturned) {
    for (const FrameShape shape : {kShape, FrameShape{20, 24, 3}, FrameShape{1, 40, 1}}) {
        const FluxVideo slot = random_video(1, shape, 1);  // up to 1
        FluxVideo video(24, shape);
        for (int i = 0; i < 24; ++i)
            std::ranges::transform(slot.frame(0), video.frame(i).begin(),
                                   [](float light) { return 3 * light; });
        const ExposureSchedule three(1, 1, 8, {0, 3}, {{0, 0b1111}, {4, 0b11}, {7, 1}});
        for (const ExposureSchedule& schedule : {alternating(), dol(), three}) {
            const FluxVideo x = decoded(record(video, schedule, rounding_sensor()), video);
            // One DN of one slot is 5 / 65535 of light; the noise that weights expect is 0.0024.
            for (std::size_t i = 0; i < x.voxels(); ++i)
                ASSERT_NEAR(x.data()[i], video.data()[i], 1e-3) << i;
        }
    }
}

TEST(Kang2003Test, AMosaicHasItsColours) {
    FluxVideo video(24, {24, 32, 3});
    for (int slot = 0; slot < video.slots(); ++slot)
        for (int plane = 0; plane < 3; ++plane)
            for (int row = 0; row < 24; ++row)
                for (float& light : video.plane(slot, plane).row(row))
                    light = 0.6F + 0.6F * static_cast<float>(plane);
    const FluxVideo x =
        decoded(record_mosaic(video, ColourFilter::kRggb, alternating(), rounding_sensor()), video);
    for (std::size_t i = 0; i < x.voxels(); ++i)
        ASSERT_NEAR(x.data()[i], video.data()[i], 2e-3) << i;
}

TEST(Kang2003Test, LostFramesAndShortClipsAreDecoded) {
    const FluxVideo video = flat_video(40, kShape, 0.5F);
    Recorded recorded = record(video, alternating(), rounding_sensor());
    std::erase_if(recorded.packets, [](const SamplePacket& packet) {
        return packet.slot == 19 || packet.slot == 29;  // a long one, a short one
    });
    const FluxVideo filled = decoded(recorded, video);
    for (const float light : filled.data()) ASSERT_NEAR(light, 0.5, 1e-3);
    for (const int slots : {1, 3, 4, 6}) {
        const FluxVideo clip = flat_video(slots, kShape, 0.5F);
        const FluxVideo x = decoded(record(clip, alternating(), rounding_sensor()), clip);
        const float expected = slots < 4 ? 0.0F : 0.5F;  // black without a complete exposure
        for (const float light : x.data()) ASSERT_NEAR(light, expected, 1e-3) << slots;
    }
}

TEST(Kang2003Test, OtherSchedulesAreRefusedByName) {
    const TemporaryFolder folder;
    for (const ExposureSchedule& schedule :
         {tiled_schedule(8, 8, kPaperExposureSlots, 1), full_schedule(4, 4)}) {
        const Recorded recorded = record(random_video(20, kShape, 1), schedule);
        write_text(folder / "a.stipple", bytes_of(recorded.header, recorded.packets).bytes);
        StreamReader reader(folder / "a.stipple");
        expect_parts(message_of<InputError>([&] {
                         return decode(reader, DecodeMethod::kKang2003,
                                       [](std::int64_t, std::span<const float>) { return true; });
                     }),
                     {"a.stipple: the method kang2003", "alternating and dol"});
    }
    const FluxVideo video = random_video(20, kShape, 1);
    EXPECT_THROW(decoded(record(video, tiled_schedule(8, 8, kPaperExposureSlots, 1)), video),
                 InputError);
    EXPECT_THROW(decoded(record(video, alternating()), video, DecodeMethod::kInterpolated),
                 InputError);
}

TEST(Kang2003Test, GivesTheSameBitsForAnyNumberOfThreads) {
    const FluxVideo video = moving_texture(24, kShape, 1.2F);
    const Recorded recorded = record(video, alternating());
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        return decoded(recorded, video);
    };
    EXPECT_TRUE(std::ranges::equal(with(1).data(), with(2).data()));
}

}  // namespace
}  // namespace stipple
