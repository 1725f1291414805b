#include "decoder/motion/frame_interpolation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "decoder/decode_options.h"
#include "decoder/frame_exposures.h"
#include "decoder/reconstruct.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/decoder/hand_made.h"
#include "tests/decoder/recordings.h"
#include "tests/support/expect_quality.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{48, 64, 1};

/// A smooth texture that moves by (rows, cols) pixels a slot.
FluxVideo moving_texture(int slots, float rows, float cols, int step = 1) {
    FluxVideo video(slots, kShape);
    for (int slot = 0; slot < slots; ++slot)
        for (int row = 0; row < kShape.rows; ++row)
            for (int col = 0; col < kShape.cols; ++col) {
                const auto t = static_cast<float>(slot * step);
                const float y = static_cast<float>(row) - rows * t;
                const float x = static_cast<float>(col) - cols * t;
                video.plane(slot, 0)(row, col) = 0.5F + 0.2F * std::sin(0.31F * x + 0.11F * y) +
                                                 0.2F * std::sin(0.23F * y - 0.17F * x);
            }
    return video;
}

double rms(std::span<const float> a, std::span<const float> b) {
    return std::sqrt(mean_square(a, b));
}

TEST(FrameInterpolationTest, GivesTheFramesThemselvesAtTheirCentres) {
    const FluxVideo frames = random_video(3, kShape, 1);
    const std::vector<float> centres{1, 5, 9};
    const FluxVideo video = interpolate_frames(frames, centres, 11);
    for (int i = 0; i < 3; ++i)
        EXPECT_TRUE(std::ranges::equal(video.frame(1 + 4 * i), frames.frame(i))) << i;
    EXPECT_TRUE(std::ranges::equal(video.frame(0), frames.frame(0)));
    EXPECT_TRUE(std::ranges::equal(video.frame(10), frames.frame(2)));
}

TEST(FrameInterpolationTest, MovesWhatMoves) {
    // 6 pixels from frame to frame: held or blended, the texture is off by up to 3 pixels.
    const FluxVideo frames = moving_texture(4, 0.5F, 1.5F, 4);
    const FluxVideo truth = moving_texture(13, 0.5F, 1.5F);
    const FluxVideo video = interpolate_frames(frames, std::vector<float>{0, 4, 8, 12}, 13);
    for (const int slot : {5, 6, 7}) {
        FluxVideo blend(1, kShape);
        for (std::size_t i = 0; i < kShape.sites(); ++i) {
            const float a = static_cast<float>(slot - 4) / 4;
            blend.data()[i] = (1 - a) * frames.frame(1)[i] + a * frames.frame(2)[i];
        }
        const double moved = rms(video.frame(slot), truth.frame(slot));
        const double blended = rms(blend.data(), truth.frame(slot));
        expect_quality("slot_" + std::to_string(slot), 2 * gain_db(moved, blended), 12.75);
    }
}

TEST(FrameInterpolationTest, IsThatOfTheSlotsAtAnyTimes) {
    const FluxVideo frames = moving_texture(3, 0.5F, 1.5F, 4);
    const std::vector<float> centres{0, 4, 8};
    const FluxVideo slots = interpolate_frames(frames, centres, 9);
    const FluxVideo some = interpolate_frames(frames, centres, std::vector<float>{3, 3.5F, 4, 9});
    EXPECT_TRUE(std::ranges::equal(some.frame(0), slots.frame(3)));
    EXPECT_LT(rms(some.frame(1), slots.frame(3)), rms(slots.frame(3), slots.frame(4)));
    EXPECT_TRUE(std::ranges::equal(some.frame(2), frames.frame(1)));
    EXPECT_TRUE(std::ranges::equal(some.frame(3), frames.frame(2)));
}

TEST(FrameInterpolationTest, MovesEachFrameToTheTimesOfItsNeighbours) {
    const FluxVideo frames = moving_texture(3, 0.5F, 1.5F, 4);  // 6 pixels from frame to frame
    const MovedFrames moved = move_frames(frames);
    for (const int i : {0, 1}) {
        const double apart = rms(frames.frame(i), frames.frame(i + 1));
        EXPECT_LT(rms(moved.next.frame(i), frames.frame(i)), apart / 4);
        EXPECT_LT(rms(moved.previous.frame(i + 1), frames.frame(i + 1)), apart / 4);
    }
    EXPECT_TRUE(std::ranges::equal(moved.previous.frame(0), frames.frame(0)));
    EXPECT_TRUE(std::ranges::equal(moved.next.frame(2), frames.frame(2)));
}

TEST(FrameInterpolationTest, GivesTheSameBitsForAnyNumberOfThreads) {
    const FluxVideo frames = moving_texture(3, 0.5F, 1.5F, 4);
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        return interpolate_frames(frames, std::vector<float>{0, 4, 8}, 9);
    };
    EXPECT_TRUE(std::ranges::equal(with(1).data(), with(2).data()));
}

TEST(FrameExposuresTest, AreThoseThatAllSitesShare) {
    const FrameShape pair{1, 2, 1};
    const auto one_of_four = hand_made(9, pair, {{0, 0}, {1, 0}, {0, 4}, {1, 4}, {0, 8}});
    const auto frames = frame_exposures(one_of_four);
    ASSERT_TRUE(frames);
    ASSERT_EQ(frames->size(), 3U) << "a sample that is missing does not matter";
    EXPECT_EQ((*frames)[1].centre_slot, 4);
    EXPECT_EQ((*frames)[1].open_slots, 1);

    const auto fluttering = frame_exposures(hand_made(5, pair, {{0, 0, 0b1011}, {1, 0, 0b1011}}));
    ASSERT_TRUE(fluttering);
    EXPECT_EQ(fluttering->front().last_slot, 3);
    EXPECT_FLOAT_EQ(fluttering->front().centre_slot, 4.0F / 3);

    const FrameShape rows{3, 1, 1};
    EXPECT_FALSE(frame_exposures(hand_made(5, rows, {{0, 0}, {1, 1}, {2, 2}})))
        << "a rolling shutter";
    EXPECT_FALSE(frame_exposures(hand_made(5, pair, {{0, 0, 3}, {1, 1, 3}}))) << "they overlap";
    EXPECT_FALSE(frame_exposures(hand_made(5, pair, {{0, 0, 1}, {1, 0, 1}, {0, 2, 3}, {1, 2, 3}})))
        << "different lengths";
    EXPECT_TRUE(frame_exposures(hand_made(2, pair, {{0, 0}, {1, 0}, {0, 1}, {1, 1}})))
        << "a frame in every slot";
}

// Light that rests, seen in one slot of four: the slots between hold no sample. Both methods must
// leave it where it is, as `naive` does.
TEST(FrameExposuresTest, WhatRestsStaysInSlotsWithoutASample) {
    FluxVideo video(40, kShape);
    for (int slot = 0; slot < 40; ++slot)
        for (int row = 0; row < kShape.rows; ++row)
            for (int col = 0; col < kShape.cols; ++col)
                video.plane(slot, 0)(row, col) =
                    row > 16 && row < 32 && col > 16 && col < 40 ? 0.73F : 0.02F;
    const ExposureSchedule schedule(1, 1, 4, {0, 1}, {{.first_slot = 0, .open_slots = 1}});
    const Recorded recorded = record(video, schedule);
    for (const DecodeMethod method : {DecodeMethod::kFast, DecodeMethod::kBest}) {
        const auto x =
            decode_block(collect_measurements(recorded.header, recorded.packets, whole(video)),
                         recorded.header.calibration, {.method = method});
        ASSERT_TRUE(x);
        for (int slot = 8; slot < 32; ++slot) {
            EXPECT_NEAR(x->plane(slot, 0)(24, 28), 0.73, 0.03) << slot;
            EXPECT_NEAR(x->plane(slot, 0)(4, 4), 0.02, 0.01) << slot;
        }
    }
}

// Frames of 4 slots each; what is interpolated between them shows more than 4.
TEST(FrameInterpolationTest, WhatFramesLackMakesTheirSlotsSumUpToThem) {
    const FluxVideo scene = moving_texture(16, 0.5F, 1.5F);
    const Measurements m = measure(scene, full_schedule(4, 4));
    const auto exposures = frame_exposures(m);
    ASSERT_TRUE(exposures);
    const FluxVideo frames = random_video(static_cast<int>(exposures->size()), kShape, 1);
    FluxVideo x = interpolate_frames(frames, centre_slots(*exposures), m.slots);
    back_project_residual(m, *exposures, frames, x);
    for (std::size_t k = 0; k < exposures->size(); ++k) {
        FluxVideo mean(1, kShape);
        for (int slot = (*exposures)[k].first_slot; slot <= (*exposures)[k].last_slot; ++slot)
            for (std::size_t i = 0; i < kShape.sites(); ++i) mean.data()[i] += x.frame(slot)[i] / 4;
        EXPECT_LT(rms(mean.data(), frames.frame(static_cast<int>(k))), 1e-6) << k;
    }
}

}  // namespace
}  // namespace stipple
