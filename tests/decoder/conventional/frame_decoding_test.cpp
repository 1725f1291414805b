// What all methods of conventional cameras have in common.
#include "decoder/conventional/frame_decoding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "decoder/conventional/conventional_schedule.h"
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

constexpr FrameShape kShape{.rows = 24, .cols = 32, .planes = 1};

class FrameMethodsTest : public testing::TestWithParam<DecodeMethod> {
  protected:
    static FluxVideo decoded(const Recorded& recorded, const FluxVideo& video) {
        return *decode_block(collect_measurements(recorded.header, recorded.packets, whole(video)),
                             recorded.header.calibration, {.method = GetParam()});
    }
    static FluxVideo decoded(const FluxVideo& video, const ExposureSchedule& schedule,
                             const SensorParams& sensor = {}) {
        return decoded(record(video, schedule, sensor), video);
    }
};

TEST_P(FrameMethodsTest, ACodedStreamIsRefusedByNameBeforeItIsRead) {
    const TemporaryFolder folder;
    const Recorded recorded =
        record(random_video(8, kShape, 1), tiled_schedule(8, 8, kPaperExposureSlots, 1));
    write_text(folder / "a.stipple", bytes_of(recorded.header, recorded.packets).bytes);
    StreamReader reader(folder / "a.stipple");
    expect_parts(message_of<InputError>([&] {
                     return decode(reader, GetParam(),
                                   [](std::int64_t, std::span<const float>) { return true; });
                 }),
                 {"a.stipple: the method " + std::string(named(GetParam()).name), "full4x"});
}

TEST_P(FrameMethodsTest, CodedMeasurementsAreRefused) {
    const FluxVideo video = random_video(20, kShape, 1);
    EXPECT_THROW(decoded(video, tiled_schedule(8, 8, kPaperExposureSlots, 1)), InputError);
}

TEST_P(FrameMethodsTest, WithoutNoiseAStaticSceneIsReturned) {
    for (const FrameShape shape : {kShape, FrameShape{20, 24, 3}}) {
        const FluxVideo slot = random_video(1, shape, 1);
        FluxVideo video(24, shape);
        for (int i = 0; i < 24; ++i) std::ranges::copy(slot.frame(0), video.frame(i).begin());
        for (const ExposureSchedule& schedule :
             {full_schedule(1, 1), full_schedule(1, 4), full_schedule(4, 4), full_schedule(3, 5)}) {
            const FluxVideo x = decoded(video, schedule, rounding_sensor());
            // One DN is 5 / 65535 of light; shot noise, which there is none of, would be 0.0014.
            for (std::size_t i = 0; i < x.voxels(); ++i)
                ASSERT_NEAR(x.data()[i], video.data()[i], 6e-4) << i;
        }
    }
}

TEST_P(FrameMethodsTest, FlaggedAsWithoutNoiseFramesAreReturnedExactly) {
    const FluxVideo video = random_video(12, kShape, 1);
    Recorded recorded = record(video, full_schedule(1, 1), rounding_sensor());
    recorded.header.calibration.noise_free = true;
    const FluxVideo x = decoded(recorded, video);
    for (std::size_t i = 0; i < x.voxels(); ++i)
        ASSERT_NEAR(x.data()[i], video.data()[i], 4e-5) << i;  // half a DN
}

TEST_P(FrameMethodsTest, FewFramesAndSmallOnesAreDecoded) {
    for (const FrameShape shape :
         {FrameShape{1, 1, 1}, FrameShape{1, 40, 3}, FrameShape{7, 9, 1}, FrameShape{17, 16, 1}})
        for (const int slots : {1, 2, 4, 9}) {
            const FluxVideo video = flat_video(slots, shape, 0.5F);
            for (const int period : {1, 4}) {
                const FluxVideo x = decoded(video, full_schedule(1, period), rounding_sensor());
                for (const float light : x.data()) ASSERT_NEAR(light, 0.5, 1e-3);
            }
        }
}

TEST_P(FrameMethodsTest, AClipShorterThanItsExposureIsBlack) {
    const FluxVideo video = flat_video(3, kShape, 0.5F);
    const FluxVideo x = decoded(video, full_schedule(4, 4));
    for (const float light : x.data()) ASSERT_EQ(light, 0);
}

// Full scale of the paper's sensor is light 2.0 in a slot.
TEST_P(FrameMethodsTest, SaturatedPixelsAreAsBrightAsTheirBound) {
    FluxVideo video = flat_video(24, kShape, 0.3F);
    for (int slot = 0; slot < 24; ++slot)
        for (int row = 8; row < 16; ++row)
            for (int col = 8; col < 16; ++col) video.plane(slot, 0)(row, col) = 9;
    const FluxVideo x = decoded(video, full_schedule(1, 4));
    for (int slot = 0; slot < 24; ++slot) {
        for (int row = 8; row < 16; ++row)
            for (int col = 8; col < 16; ++col)
                ASSERT_GE(x.plane(slot, 0)(row, col), slot % 4 == 0 ? 1.99F : 1.9F);
        ASSERT_NEAR(x.plane(slot, 0)(3, 24), 0.3, 0.1);
    }
}

TEST_P(FrameMethodsTest, LostFramesAndRowsAreFilled) {
    const FluxVideo video = flat_video(40, kShape, 0.5F);
    Recorded recorded = record(video, full_schedule(1, 4), rounding_sensor());
    recorded.packets.erase(recorded.packets.begin() + 16);  // the frame of slot 16
    SamplePacket& packet = recorded.packets[27];  // the frame of slot 28, by its upper third
    ASSERT_EQ(packet.slot, 28);
    packet.rows = kShape.rows / 3;
    packet.dn.resize(static_cast<std::size_t>(packet.rows) * kShape.cols);
    const FluxVideo x = decoded(recorded, video);
    for (const float light : x.data()) ASSERT_NEAR(light, 0.5, 1e-3);
}

TEST_P(FrameMethodsTest, AMosaicHasItsColours) {
    FluxVideo video(16, {24, 32, 3});
    for (int slot = 0; slot < 16; ++slot)
        for (int plane = 0; plane < 3; ++plane)
            for (float& light : video.plane(slot, plane).row(0)) light = 0;
    for (int slot = 0; slot < 16; ++slot)
        for (int plane = 0; plane < 3; ++plane)
            for (int row = 0; row < 24; ++row)
                for (int col = 0; col < 32; ++col)
                    video.plane(slot, plane)(row, col) = 0.2F + 0.2F * static_cast<float>(plane);
    const Recorded recorded =
        record_mosaic(video, ColourFilter::kRggb, full_schedule(1, 4), rounding_sensor());
    const FluxVideo x = decoded(recorded, video);
    for (std::size_t i = 0; i < x.voxels(); ++i)
        ASSERT_NEAR(x.data()[i], video.data()[i], 2e-3) << i;
}

// Of two slots with the weights 0.25 and 0.75, or half of these behind every other pixel.
TEST_P(FrameMethodsTest, WeightedExposuresGiveLightPerSlot) {
    ExposureSchedule schedule(1, 2, 4, {0, 1, 2}, {{0, 3}, {0, 3}});
    schedule.set_weights({0.25F, 0.125F, 0.75F, 0.375F, 0, 0, 0, 0});
    ASSERT_TRUE(conventional(schedule));
    const FluxVideo video = flat_video(24, kShape, 0.5F);
    const FluxVideo x = decoded(video, schedule, rounding_sensor());
    for (const float light : x.data()) ASSERT_NEAR(light, 0.5, 2e-3);
}

TEST_P(FrameMethodsTest, GivesTheSameBitsForAnyNumberOfThreads) {
    const FluxVideo video = moving_texture(24, kShape, 1.2F);
    const Recorded recorded = record(video, full_schedule(4, 4));
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        return decoded(recorded, video);
    };
    EXPECT_TRUE(std::ranges::equal(with(1).data(), with(2).data()));
}

TEST_P(FrameMethodsTest, StopsWhenTheProgressDoes) {
    if (GetParam() == DecodeMethod::kInterpolated) return;  // has no step to stop after
    const FluxVideo video = moving_texture(12, kShape, 1);
    const Recorded recorded = record(video, full_schedule(2, 2));
    EXPECT_FALSE(decode_block(collect_measurements(recorded.header, recorded.packets, whole(video)),
                              recorded.header.calibration, {.method = GetParam()},
                              [](double done) { return done < 0.3; }));
}

INSTANTIATE_TEST_SUITE_P(Methods, FrameMethodsTest,
                         testing::Values(DecodeMethod::kInterpolated, DecodeMethod::kBennett2005,
                                         DecodeMethod::kZhang2009, DecodeMethod::kVbm4d,
                                         DecodeMethod::kShahar2011),
                         [](const auto& test) { return std::string(named(test.param).name); });

}  // namespace
}  // namespace stipple
