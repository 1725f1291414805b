#include "decoder/fast/pseudo_samples.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "decoder/naive/nearest_samples.h"
#include "decoder/pixel_response.h"
#include "readout/coded_sensor.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/decoder/hand_made.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

/// The measurements with pseudo-samples.
Measurements with_pseudo_samples(Measurements m) {
    const FluxVideo nearest = nearest_samples(m);
    const PseudoSamples samples(m, nearest, paper_noise());
    Measurements copy = m;
    return copy;
}

TEST(PseudoSamplesTest, WhatRestsIsPresumedAsWellAsASampleKnowsIt) {
    const Measurements m = with_pseudo_samples(hand_made(9, kSite,
                                                         {{.first_slot = 0, .light = 0.5F},
                                                          {.first_slot = 4, .light = 0.5F},
                                                          {.first_slot = 8, .light = 0.5F}}));
    for (const std::size_t slot : {1U, 2U, 3U, 5U, 6U, 7U}) {
        EXPECT_NE(m.state[slot] & Measurements::kPseudo, 0) << slot;
        EXPECT_FLOAT_EQ(m.sum[slot], 0.5F);
        EXPECT_FLOAT_EQ(m.variance[slot], paper_noise().variance(0.5F));
    }
    EXPECT_EQ(m.state[4] & Measurements::kPseudo, 0);
}

// 8 squared changes; the change itself is known but for 2e-4, the variances of its two samples.
TEST(PseudoSamplesTest, LittleIsPresumedOfWhatChanges) {
    const Measurements m = with_pseudo_samples(
        hand_made(5, kSite, {{.first_slot = 0, .light = 0.1F}, {.first_slot = 4, .light = 0.9F}}));
    EXPECT_NEAR(m.variance[2], 8 * (0.8 * 0.8 - 2e-4), 0.01);
}

TEST(PseudoSamplesTest, AThingNearbyThatChangesCastsDoubt) {
    const FrameShape two{.rows = 1, .cols = 2, .planes = 1};
    const Measurements m =
        with_pseudo_samples(hand_made(5, two,
                                      {{.site = 0, .first_slot = 0, .light = 0.5F},
                                       {.site = 0, .first_slot = 4, .light = 0.5F},
                                       {.site = 1, .first_slot = 0, .light = 0.1F},
                                       {.site = 1, .first_slot = 4, .light = 0.9F}}));
    EXPECT_GT(m.variance[2 * 2 + 0], 1);
}

TEST(PseudoSamplesTest, ASaturatedSampleBetweenBrighterOnesIsAsBrightAsThey) {
    const Measurements m = with_pseudo_samples(hand_made(
        6, kSite,
        {{.first_slot = 0, .light = 1.5F},
         {.first_slot = 1, .open_slots = 0b1111, .light = 2, .saturated = true},  // 0.5 a slot
         {.first_slot = 5, .light = 1.5F}}));
    EXPECT_EQ(m.state[4] & Measurements::kSaturated, 0);
    EXPECT_FLOAT_EQ(m.sum[4], 6);
}

TEST(PseudoSamplesTest, ASaturatedSampleBetweenDarkerOnesStaysABound) {
    const Measurements m = with_pseudo_samples(
        hand_made(6, kSite,
                  {{.first_slot = 0, .light = 0.2F},
                   {.first_slot = 1, .open_slots = 0b1111, .light = 2, .saturated = true},
                   {.first_slot = 5, .light = 0.2F}}));
    EXPECT_NE(m.state[4] & Measurements::kSaturated, 0);
    EXPECT_FLOAT_EQ(m.sum[4], 2);
}

TEST(PseudoSamplesTest, WhereAllIsSaturatedTheHighestBoundHoldsForAll) {
    const Measurements m = with_pseudo_samples(
        hand_made(5, kSite,
                  {{.first_slot = 0, .light = 2, .saturated = true},
                   {.first_slot = 1, .open_slots = 0b1111, .light = 2, .saturated = true}}));
    EXPECT_NE(m.state[4] & Measurements::kSaturated, 0);
    EXPECT_FLOAT_EQ(m.sum[4], 8);
}

TEST(PseudoSamplesTest, ClosedSlotsOfAnExposureAreNotItsOwn) {
    const Measurements m =
        with_pseudo_samples(hand_made(10, kSite,
                                      {{.first_slot = 0, .open_slots = 0b10101, .light = 1.5F},
                                       {.first_slot = 5, .open_slots = 0b10101, .light = 1.5F}}));
    for (const std::size_t slot : {1U, 3U, 6U, 8U}) {
        EXPECT_NE(m.state[slot] & Measurements::kSecond, 0) << slot;
        EXPECT_FLOAT_EQ(m.sum[slot], 0.5F);
    }
    EXPECT_TRUE(m.interleaved);
    EXPECT_FLOAT_EQ(m.sum[4], 1.5F);
}

TEST(PseudoSamplesTest, ClosedSlotsInWhichOthersAreOpenAreLeftToThePrior) {
    const FrameShape two{.rows = 1, .cols = 2, .planes = 1};
    const Measurements before =
        hand_made(5, two,
                  {{.site = 0, .first_slot = 0, .open_slots = 0b10101, .light = 1.5F},
                   {.site = 1, .first_slot = 0, .open_slots = 0b11011, .light = 2}});
    EXPECT_EQ(with_pseudo_samples(before).state, before.state);
}

// Light to twice what a sample of one slot holds, so that all kinds of bounds are met.
TEST(PseudoSamplesTest, TheMeasurementsAreRestoredAtTheEnd) {
    const FrameShape shape{.rows = 20, .cols = 24, .planes = 1};
    FluxVideo video(40, shape);
    for (std::size_t i = 0; i < video.voxels(); ++i)
        video.data()[i] = static_cast<float>(i % 97) / 24;
    const int lengths[] = {1, 2, 4, 8};
    for (const ExposureSchedule& schedule :
         {tiled_schedule(8, 8, lengths, 1), full_schedule(2, 5)}) {
        const Measurements before = measure(video, schedule);
        Measurements m = before;
        const FluxVideo nearest = nearest_samples(m);
        {
            const PseudoSamples samples(m, nearest, paper_noise());
            EXPECT_NE(m.sum, before.sum);
            EXPECT_TRUE(std::ranges::any_of(
                m.state, [](auto s) { return (s & Measurements::kPseudo) != 0; }));
        }
        EXPECT_EQ(m.state, before.state);
        EXPECT_EQ(m.sum, before.sum);
        EXPECT_EQ(m.interleaved, before.interleaved);
    }
}

}  // namespace
}  // namespace stipple
