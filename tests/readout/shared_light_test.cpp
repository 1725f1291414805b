// Terms by which exposures and pixels share light: lag, closed stores, blooming, row skew.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "core/flux_video.h"
#include "readout/coded_sensor.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

/// No noise, 1 DN an electron, 100 e a slot at flux 1; 1000 e of full well.
SensorParams sensor(const PhysicalTerms& terms) {
    return {.photons_per_unit = 100,
            .full_scale_e = 65535,
            .full_well_e = 1000,
            .read_noise_e = 0,
            .shot_noise = false,
            .bit_depth = 16,
            .mode = SensorMode::kPhysical,
            .physical = terms};
}

/// Light of each slot, the same at all pixels.
FluxVideo uniform(const std::vector<float>& light, FrameShape shape) {
    FluxVideo video(static_cast<int>(light.size()), shape);
    for (int slot = 0; slot < video.slots(); ++slot)
        std::ranges::fill(video.frame(slot), light[static_cast<std::size_t>(slot)]);
    return video;
}

using Slots = std::vector<std::vector<std::uint16_t>>;

Slots expose(const FluxVideo& video, const ExposureSchedule& schedule, const SensorParams& params) {
    CodedSensor chip(params, video.shape(), schedule, 1);
    SamplePacket packet;
    Slots dn;
    for (int slot = 0; slot < video.slots(); ++slot) {
        chip.expose(video.frame(slot), packet);
        dn.push_back(packet.dn);
    }
    return dn;
}

/// The exposures of one store of a two-bucket schedule of one pixel: a schedule without
/// interleaving. A store may change sides from period to period, so it has two periods.
ExposureSchedule of_store(const ExposureSchedule& schedule, int store) {
    const auto period = static_cast<std::uint32_t>(schedule.period_slots());
    const auto both = schedule.exposures(0, 0);
    std::vector<Exposure> own;
    for (std::uint32_t repetition = 0; repetition < 2; ++repetition)
        for (std::size_t i = 0; i < both.size(); ++i)
            if (schedule.store(0, 0, i, repetition) == store)
                own.push_back({repetition * period + both[i].first_slot, both[i].open_slots});
    const auto count = static_cast<std::uint32_t>(own.size());
    return {1, 1, schedule.period_slots() * 2, {0, count}, own};
}

/// Two-bucket pixels read what two chips read that have one store each.
void expect_two_stores_are_two_chips(const PhysicalTerms& terms) {
    std::mt19937 random(1);
    FluxVideo video(120, {.rows = 5, .cols = 6, .planes = 2});
    for (float& flux : video.data()) flux = static_cast<float>(random() % 4096) / 512;
    SensorParams two = sensor(terms);
    SensorParams ideal = sensor({});
    two.charge_stores = ideal.charge_stores = 2;
    for (const auto& schedule : {alternating_schedule(), interleaved_schedule(1, 1, 9, 1),
                                 interleaved_schedule(1, 1, 8, 2)}) {
        ASSERT_TRUE(schedule.interleaved());
        const Slots given = expose(video, schedule, two);
        EXPECT_NE(given, expose(video, schedule, ideal)) << "the test means something";
        const Slots first = expose(video, of_store(schedule, 0), sensor(terms));
        const Slots second = expose(video, of_store(schedule, 1), sensor(terms));
        for (std::size_t slot = 0; slot < given.size(); ++slot) {
            ASSERT_TRUE(first[slot].empty() || second[slot].empty());
            EXPECT_EQ(given[slot], first[slot].empty() ? second[slot] : first[slot]) << slot;
        }
    }
}

TEST(LagTest, AStepLeavesPowersOfTheLagAndSteadyLightNothing) {
    const FrameShape shape{.rows = 2, .cols = 3, .planes = 1};
    const SensorParams params = sensor({.lag = 0.25});
    const std::vector<std::uint16_t> step{600, 750, 188, 47};  // 800 (1 - l), then l 800 ...
    const auto dn = expose(uniform({8, 8, 0, 0}, shape), full_schedule(1, 1), params);
    EXPECT_EQ(dn[0], std::vector<std::uint16_t>(6, 600));
    EXPECT_EQ(dn[1], std::vector<std::uint16_t>(6, 750));
    EXPECT_EQ(dn[2], std::vector<std::uint16_t>(6, 188));  // 250 (1 - l), rounded
    EXPECT_EQ(dn[3], std::vector<std::uint16_t>(6, 47));
}

TEST(LagTest, LeavesAtMostItsFractionOfAFullWell) {
    const auto dn = expose(uniform({1e6F, 0}, {.rows = 1, .cols = 1, .planes = 1}),
                           full_schedule(1, 1), sensor({.lag = 0.5}));
    EXPECT_EQ(dn[0][0], 1000);
    EXPECT_EQ(dn[1][0], 250);
}

TEST(ParasiticLightTest, AClosedStoreCollectsItsFractionOfTheLight) {
    // Open in slot 0 of 4, read in it; closed in the other three.
    const ExposureSchedule flutter(1, 1, 4, {0, 1}, {{0, 1}});
    const auto video = uniform({1, 1, 1, 1, 1}, {.rows = 1, .cols = 2, .planes = 1});
    const auto dn = expose(video, flutter, sensor({.parasitic_light_sensitivity = 0.1}));
    EXPECT_EQ(dn[0], std::vector<std::uint16_t>(2, 100));
    EXPECT_EQ(dn[4], std::vector<std::uint16_t>(2, 130));
}

TEST(ParasiticLightTest, DoesNothingWhereEachStoreIsAlwaysOpen) {
    const auto video = uniform({1, 2, 3, 4, 5, 6}, {.rows = 8, .cols = 8, .planes = 1});
    const auto schedule = random_schedule(8, 8, kPaperExposureSlots, 1);
    EXPECT_EQ(expose(video, schedule, sensor({.parasitic_light_sensitivity = 0.5})),
              expose(video, schedule, sensor({})));
}

TEST(ParasiticLightTest, ReachesTheClosedStoreOfATwoBucketPixel) {
    // Each store is read every fourth slot; of these four slots it is open in two.
    const auto video = uniform({1, 1, 1, 1, 1, 1, 1, 1, 1, 1}, {.rows = 1, .cols = 1, .planes = 1});
    SensorParams params = sensor({.parasitic_light_sensitivity = 0.5});
    params.charge_stores = 2;
    const auto dn = expose(video, alternating_schedule(), params);
    for (const std::size_t slot : {3U, 7U, 9U}) EXPECT_EQ(dn[slot][0], 300) << slot;
}

TEST(BloomingTest, ChargeBeyondTheFullWellReachesTheNeighbours) {
    FluxVideo video(1, {.rows = 3, .cols = 3, .planes = 1});
    video.plane(0, 0)(1, 1) = 18;  // 1800 e, 800 beyond the full well
    const auto dn = expose(video, full_schedule(1, 1), sensor({.blooming = 0.5}));
    EXPECT_EQ(dn[0], (std::vector<std::uint16_t>{0, 100, 0, 100, 1000, 100, 0, 100, 0}));
}

TEST(BloomingTest, CountsTheChargeOfEarlierSlotsOfTheExposure) {
    FluxVideo video(2, {.rows = 1, .cols = 2, .planes = 1});
    for (int slot = 0; slot < 2; ++slot) video.plane(slot, 0)(0, 0) = 8;  // 800 e, then 1600 e
    const auto dn = expose(video, full_schedule(2, 2), sensor({.blooming = 1}));
    EXPECT_EQ(dn[1], (std::vector<std::uint16_t>{1000, 150}));
}

TEST(TwoStoresTest, EachKeepsTheLagOfItsOwnExposures) {
    expect_two_stores_are_two_chips({.lag = 0.25});
}

TEST(TwoStoresTest, EachCollectsItsOwnParasiticLight) {
    expect_two_stores_are_two_chips({.parasitic_light_sensitivity = 0.125});
}

// No pixel has an open store while another one has the other open, so no charge goes from one chip
// to the other.
TEST(TwoStoresTest, TheOpenOneOverflows) {
    expect_two_stores_are_two_chips({.blooming = 0.5});
}

TEST(TwoStoresTest, WhatLagLeavesInAStoreCountsTowardsItsOverflow) {
    expect_two_stores_are_two_chips({.blooming = 0.5, .lag = 0.25});
}

TEST(RowSkewTest, ALaterRowSeesTheSlotBefore) {
    const auto video = uniform({1, 5}, {.rows = 3, .cols = 1, .planes = 1});
    const auto dn = expose(video, full_schedule(1, 1), sensor({.row_skew_slots = 1}));
    EXPECT_EQ(dn[1], (std::vector<std::uint16_t>{500, 300, 100}));
}

}  // namespace
}  // namespace stipple
