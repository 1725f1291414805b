#include "capture/loss_counter.h"

#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <vector>

#include "tests/capture/scripted_camera.h"

namespace stipple {
namespace {

using namespace std::chrono_literals;

constexpr LossCounter::Clock::time_point kStart{};

/// A camera whose transport has counted so much.
std::unique_ptr<ScriptedCamera> camera_with(const TransportCounts& counts) {
    auto camera = std::make_unique<ScriptedCamera>(std::deque{arrives(scripted_frame(1), counts)});
    static_cast<void>(camera->wait(0ms));
    return camera;
}

std::uint64_t lost_by(const LossCounter& losses, GapCause cause) {
    return losses.lost()[static_cast<std::size_t>(cause)];
}

TEST(LossCounterTest, WhatTheTransportHasCountedSinceIsTheCause) {
    LossCounter losses;
    losses.begin_epoch(kStart);
    losses.count_unexplained(*camera_with({.underruns = 1}), 2, kStart);
    losses.count_unexplained(*camera_with({.underruns = 1, .packets_missing = 7}), 3, kStart);
    losses.count_unexplained(*camera_with({.underruns = 1, .packets_missing = 7}), 4, kStart);
    EXPECT_EQ(lost_by(losses, GapCause::kHostUnderrun), 2U);
    EXPECT_EQ(lost_by(losses, GapCause::kTransport), 3U);
    EXPECT_EQ(lost_by(losses, GapCause::kDevice), 4U);
    FrameGap gap = losses.take_gap();
    EXPECT_EQ(gap.total(), 9U);
    EXPECT_EQ(gap.cause(), GapCause::kDevice);
    EXPECT_EQ(losses.take_gap().total(), 0U);
    EXPECT_EQ(lost_by(losses, GapCause::kDevice), 4U);  // of the whole session
}

TEST(LossCounterTest, PacketsOfAnIncompleteFrameExplainNoOther) {
    LossCounter losses;
    losses.begin_epoch(kStart);
    losses.note_incomplete();
    losses.count_unexplained(*camera_with({.packets_missing = 1}), 1, kStart);
    EXPECT_EQ(lost_by(losses, GapCause::kDevice), 1U);
    losses.count_unexplained(*camera_with({.packets_missing = 2}), 1, kStart);  // no further one
    EXPECT_EQ(lost_by(losses, GapCause::kTransport), 1U);
}

TEST(LossCounterTest, AnUnderrunIsKeptUntilItsFrameIsMissing) {
    const auto camera = camera_with({.underruns = 1});
    LossCounter losses;
    losses.begin_epoch(kStart);
    losses.note_frame(*camera, kStart + LossCounter::kCountEvery);
    losses.count_unexplained(*camera, 1, kStart + LossCounter::kCountEvery);
    EXPECT_EQ(lost_by(losses, GapCause::kHostUnderrun), 1U);
}

TEST(LossCounterTest, CountersAreReadAtIntervals) {
    const auto camera = camera_with({.socket_drops = 1});
    LossCounter losses;
    losses.begin_epoch(kStart);
    losses.note_frame(*camera, kStart + LossCounter::kCountEvery - 1ms);  // not read
    losses.count_unexplained(*camera, 1, kStart);
    EXPECT_EQ(lost_by(losses, GapCause::kTransport), 1U);
}

TEST(LossCounterTest, UnderrunsAfterTheLastFrameAreLostFrames) {
    LossCounter losses;
    losses.begin_epoch(kStart);
    losses.count_last_underruns(*camera_with({.underruns = 3}), kStart);
    EXPECT_EQ(lost_by(losses, GapCause::kHostUnderrun), 3U);
    EXPECT_EQ(losses.take_gap().total(), 0U);  // no frame follows
}

TEST(LossCounterTest, TheCountersOfAllEpochsAddUp) {
    const auto first = camera_with({.underruns = 3, .packets_resent = 5});
    const auto second = camera_with({.underruns = 1});
    LossCounter losses;
    losses.begin_epoch(kStart);
    losses.end_epoch(*first, kStart);
    EXPECT_EQ(losses.transport(nullptr).underruns, 3U);
    losses.begin_epoch(kStart);
    EXPECT_EQ(losses.transport(second.get()).underruns, 4U);
    EXPECT_EQ(losses.transport(second.get()).packets_resent, 5U);
    losses.count_unexplained(*second, 1, kStart);  // its counters began with 0
    EXPECT_EQ(lost_by(losses, GapCause::kHostUnderrun), 1U);
}

}  // namespace
}  // namespace stipple
