#include "readout/coded_sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/flux_video.h"
#include "core/parallel.h"
#include "readout/column_adc.h"
#include "readout/schedules/tiled_schedule.h"
#include "sensor_model/pixel_array.h"
#include "tests/readout/gapped_schedule.h"
#include "tests/support/fnv1a.h"
#include "tests/support/source_tree.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr std::uint64_t kSeed = 3;
constexpr FrameShape kShape{.rows = 37, .cols = 53, .planes = 3};  // three bands, the last partial

/// Light from none to far beyond the full well, exact in every arithmetic.
FluxVideo footage(int slots, FrameShape shape) {
    FluxVideo video(slots, shape);
    std::mt19937 random(1);
    for (float& flux : video.data()) {
        const float mantissa = static_cast<float>(random() % 4096) / 4096;
        flux = mantissa * static_cast<float>(1U << (random() % 7)) / 16;
    }
    return video;
}

using Slots = std::vector<std::vector<std::uint16_t>>;  ///< DN of each slot

Slots expose_all(const FluxVideo& video, const ExposureSchedule& schedule,
                 const SensorParams& params = {}) {
    CodedSensor sensor(params, video.shape(), schedule, kSeed);
    SamplePacket packet;
    Slots dn;
    for (int slot = 0; slot < video.slots(); ++slot) {
        sensor.expose(video.frame(slot), packet);
        EXPECT_EQ(packet.slot, slot);
        EXPECT_EQ(packet.first_row, 0);
        EXPECT_EQ(packet.rows, video.shape().rows);
        dn.push_back(packet.dn);
    }
    return dn;
}

/// The DN of one exposure: light summed slot by slot, then Eq. 1 for this one sample.
std::uint16_t expose_once(const FluxVideo& video, const TakenExposure& taken, int row, int col,
                          int plane, const SensorParams& params) {
    float light = 0;
    for (int i = 0; i < taken.exposure.span_slots(); ++i)
        if ((taken.exposure.open_slots >> static_cast<unsigned>(i) & 1U) != 0)
            light += video.plane(static_cast<int>(taken.begin_slot) + i, plane)(row, col);
    const std::uint32_t pixel = static_cast<std::uint32_t>(row * video.shape().cols + col);
    float electrons = 0;
    PixelArray(params, kSeed)
        .expose({&light, 1}, {&pixel, 1}, static_cast<std::uint32_t>(taken.last_slot()),
                static_cast<std::uint32_t>(plane), {.electrons = {&electrons, 1}});
    return ColumnAdc(params).convert_one(electrons);
}

/// The slow, obvious sensor: exposure by exposure.
Slots expose_one_by_one(const FluxVideo& video, const ExposureSchedule& schedule,
                        const SensorParams& params = {}) {
    Slots dn(static_cast<std::size_t>(video.slots()));
    const FrameShape shape = video.shape();
    for (int row = 0; row < shape.rows; ++row)
        for (int col = 0; col < shape.cols; ++col)
            for (const auto& taken : taken_exposures(schedule, row, col, video.slots())) {
                if (taken.last_slot() >= video.slots()) continue;
                auto& slot = dn[static_cast<std::size_t>(taken.last_slot())];
                for (int plane = 0; plane < shape.planes; ++plane)
                    slot.push_back(expose_once(video, taken, row, col, plane, params));
            }
    return dn;
}

TEST(CodedSensorTest, IsTheSlowSensorOnTheSchedulesOfTheCatalogue) {
    const FluxVideo video = footage(40, kShape);
    for (const auto& schedule : {random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1),
                                 tiled_schedule(16, 16, kPaperExposureSlots, 1),
                                 tiled_schedule(64, 64, kPaperExposureSlots, 1),
                                 full_schedule(4, 4), full_schedule(1, 4), full_schedule(3, 7)})
        EXPECT_EQ(expose_all(video, schedule), expose_one_by_one(video, schedule));
}

TEST(CodedSensorTest, IsTheSlowSensorWithGapsBetweenAndWithinExposures) {
    const FluxVideo video = footage(70, {.rows = 19, .cols = 23, .planes = 2});
    for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
        const auto schedule = gapped_schedule(3, 5, 29, seed);
        EXPECT_LT(schedule.light_throughput(), 0.8);
        EXPECT_EQ(expose_all(video, schedule), expose_one_by_one(video, schedule)) << seed;
    }
    const auto large_tile = gapped_schedule(32, 40, 17, 5);
    EXPECT_EQ(expose_all(video, large_tile), expose_one_by_one(video, large_tile));
}

TEST(CodedSensorTest, IsTheSlowSensorWithTwoChargeStores) {
    const FluxVideo video = footage(70, {.rows = 19, .cols = 23, .planes = 2});
    const SensorParams two_bucket{.charge_stores = 2};
    for (const auto& schedule : {alternating_schedule(), interleaved_schedule(3, 5, 8, 1),
                                 interleaved_schedule(32, 40, 5, 2)})
        EXPECT_EQ(expose_all(video, schedule, two_bucket),
                  expose_one_by_one(video, schedule, two_bucket));
}

TEST(CodedSensorTest, KeepsLongExposuresThatFillTheMask) {
    const FluxVideo video = footage(200, {.rows = 5, .cols = 7, .planes = 1});
    const int lengths[] = {64, 1, 33};
    const auto schedule = random_schedule(5, 7, lengths, 9);
    EXPECT_EQ(expose_all(video, schedule), expose_one_by_one(video, schedule));
}

TEST(CodedSensorTest, GivesTheSameBitsForAnyNumberOfThreads) {
    const FluxVideo video = footage(20, {.rows = 100, .cols = 64, .planes = 3});
    const auto schedule = random_schedule(100, 64, kPaperExposureSlots, 1);
    const auto with_threads = [&](int threads) {
        const ThreadLimit limit(threads);
        return expose_all(video, schedule);
    };
    EXPECT_EQ(with_threads(1), with_threads(2));
}

TEST(CodedSensorTest, ReadsNoExposureThatBeganBeforeTheFirstSlot) {
    const FluxVideo video = footage(30, kShape);
    const auto schedule = random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1);
    const Slots dn = expose_all(video, schedule);
    for (int slot = 0; slot < 30; ++slot)
        EXPECT_EQ(dn[static_cast<std::size_t>(slot)].size(),
                  3 * count_due(schedule, slot, 0, kShape.rows, kShape.cols));
    // At the end of slot 0 only exposures of one slot are over; their share is 1 in 4 of the due.
    EXPECT_LT(dn[0].size() * 2, dn[15].size());
}

TEST(CodedSensorTest, GivesTheDnOfTheFormulaWithoutNoise) {
    // Flux 1/4 at 1000 e: 250 e per slot, 2000 e over 8 slots, exactly full scale. DN = 255/8 n for
    // n slots: 31.875 -> 32, 63.75 -> 64, 127.5 -> 128, 255.
    const SensorParams params{.read_noise_e = 0, .shot_noise = false};
    const FrameShape shape{.rows = 8, .cols = 8, .planes = 1};
    FluxVideo video(30, shape);
    std::ranges::fill(video.data(), 0.25F);
    const auto schedule = random_schedule(8, 8, kPaperExposureSlots, 1);
    const Slots dn = expose_all(video, schedule, params);
    for (int slot = 0; slot < video.slots(); ++slot) {
        std::size_t i = 0;
        for (int row = 0; row < shape.rows; ++row)
            for_each_readout(schedule, slot, row, shape.cols, [&](int, int span_slots) {
                const int expected = (span_slots * 255 + 4) / 8;
                ASSERT_EQ(dn[static_cast<std::size_t>(slot)][i++], expected) << span_slots;
            });
    }
}

TEST(CodedSensorTest, CountsSlotsSamplesAndThoseAtFullScaleAndZero) {
    const FluxVideo video = footage(25, kShape);
    const auto schedule = random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1);
    CodedSensor sensor({}, kShape, schedule, kSeed);
    SamplePacket packet;
    packet.flags = SamplePacket::kDropped;  // what an earlier user left behind
    std::uint64_t samples = 0;
    std::uint64_t saturated = 0;
    std::uint64_t zeros = 0;
    for (int slot = 0; slot < video.slots(); ++slot) {
        sensor.expose(video.frame(slot), packet);
        EXPECT_EQ(packet.flags, 0);
        samples += packet.dn.size();
        saturated += static_cast<std::uint64_t>(std::ranges::count(packet.dn, 255));
        zeros += static_cast<std::uint64_t>(std::ranges::count(packet.dn, 0));
    }
    EXPECT_EQ(sensor.stats().slots, 25);
    EXPECT_EQ(sensor.stats().samples, samples);
    EXPECT_EQ(sensor.stats().saturated_samples, saturated);
    EXPECT_GT(saturated, 0U);
    EXPECT_LT(saturated, samples);
    EXPECT_EQ(sensor.stats().zero_samples, zeros);
    EXPECT_GT(zeros, 0U);
}

// Without noise an exposure of n slots of the light x is clipped if n r x exceeds the full well,
// which here is below full scale; 2000 e is just the charge of four slots.
TEST(CodedSensorTest, CountsSamplesThatTheFullWellClips) {
    FluxVideo video(30, {.rows = 40, .cols = 24, .planes = 3});
    std::ranges::fill(video.data(), 0.5F);
    const auto schedule = random_schedule(40, 24, kPaperExposureSlots, 1);
    for (const double full_well_e : {1500, 2000})
        for (const SensorMode mode : {SensorMode::kPaper, SensorMode::kPhysical}) {
            const SensorParams params{.full_scale_e = 5000,
                                      .full_well_e = full_well_e,
                                      .read_noise_e = 0,
                                      .shot_noise = false,
                                      .mode = mode};
            CodedSensor sensor(params, video.shape(), schedule, kSeed);
            SamplePacket packet;
            std::uint64_t clipped = 0;
            for (int slot = 0; slot < video.slots(); ++slot) {
                sensor.expose(video.frame(slot), packet);
                for (int row = 0; row < 40; ++row)
                    for_each_readout(schedule, slot, row, 24, [&](int, int span_slots) {
                        if (span_slots * 500 > full_well_e) clipped += 3;
                    });
            }
            EXPECT_EQ(sensor.stats().saturated_samples, clipped);
        }
}

TEST(CodedSensorTest, TakesInfiniteLightAsSaturation) {
    FluxVideo video(8, {.rows = 2, .cols = 2, .planes = 1});
    std::ranges::fill(video.data(), std::numeric_limits<float>::infinity());
    for (const auto& dn : expose_all(video, gapped_schedule(1, 3, 8, 1)))
        for (const std::uint16_t value : dn) EXPECT_EQ(value, 255);
}

// A recording on purpose: the bits of a stream are promised on every machine and compiler.
TEST(CodedSensorTest, KeepsTheRecordedBits) {
    const FluxVideo video = footage(30, kShape);
    const auto schedule = random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1);
    Fnv1a hash;
    for (const auto& slot : expose_all(video, schedule))
        for (const std::uint16_t dn : slot) hash.add(dn, 2);
    const auto folder = project_path("tests/golden/readout");
    std::uint64_t golden = 0;
    std::ifstream(folder / "coded_sensor_dn.fnv1a") >> std::hex >> golden;
    EXPECT_EQ(hash.hash(), golden) << std::hex << hash.hash();
}

TEST(CodedSensorTest, RefusesSchedulesOfMoreChargeStoresThanItHas) {
    const ExposureSchedule two(1, 2, 6, {0, 1, 3}, {{0, 1}, {0, 0b101}, {1, 0b101}});
    expect_parts(message_of<InputError>([&] { CodedSensor({}, kShape, two, kSeed); }),
                 {"pixel (0, 1) slot 1", "interleave", "charge_stores=2"});
    const ExposureSchedule three(1, 1, 9, {0, 3}, {{0, 0b1001}, {1, 0b1001}, {2, 0b1001}});
    const SensorParams two_bucket{.charge_stores = 2};
    expect_parts(message_of<InputError>([&] { CodedSensor(two_bucket, kShape, three, kSeed); }),
                 {"pixel (0, 0) slot 2", "needs 3", "the sensor has 2"});
}

TEST(CodedSensorTest, RefusesEmptyArraysAndBadSensors) {
    const auto full = full_schedule(4, 4);
    expect_parts(message_of<InputError>([&] {
                     CodedSensor({}, {0, 8, 1}, full, kSeed);
                 }),
                 {"0 x 8 pixels"});
    EXPECT_THROW(CodedSensor({}, {8, -1, 1}, full, kSeed), InputError);
    EXPECT_THROW(CodedSensor({}, {8, 8, 0}, full, kSeed), InputError);
    EXPECT_THROW(CodedSensor({.bit_depth = 0}, kShape, full, kSeed), InputError);
    EXPECT_THROW(CodedSensor({.charge_stores = 0}, kShape, full, kSeed), InputError);
}

TEST(CalibrationOfTest, SaysTheGainNoiseAndWellOfEquationOne) {
    EXPECT_EQ(calibration_of({}), Calibration{});  // the defaults of both are the paper's
    const Calibration found = calibration_of({.photons_per_unit = 500,
                                              .full_scale_e = 8190,
                                              .full_well_e = 9000,
                                              .read_noise_e = 2.5,
                                              .bit_depth = 12,
                                              .rounding = Rounding::kFloor});
    const Calibration expected{.bit_depth = 12,
                               .rounding = Rounding::kFloor,
                               .black_level_dn = 0,
                               .gain_e_per_dn = 2,
                               .read_noise_e = 2.5,
                               .full_well_e = 9000,
                               .electrons_per_unit = 500};
    EXPECT_EQ(found, expected);
}

TEST(CalibrationOfTest, SaysTheReadAndResetNoiseOfASample) {
    const Calibration found = calibration_of(
        {.read_noise_e = 9, .mode = SensorMode::kPhysical, .physical = {.reset_noise_e = 12}});
    EXPECT_DOUBLE_EQ(found.read_noise_e, 15);
}

// 20000 e/s in 5 ms are 100 e, and 50 in the mean over the rows; one DN is 2 e.
TEST(CalibrationOfTest, TheBlackLevelAndItsNoiseHaveTheMeanLeakageOfTheStorageNodes) {
    const SensorParams params{
        .full_scale_e = 8190,
        .bit_depth = 12,
        .mode = SensorMode::kPhysical,
        .physical = {
            .storage_dark_current_e_per_s = 20000, .storage_wait_us = 5000, .black_level_dn = 40}};
    const Calibration found = calibration_of(params);
    EXPECT_DOUBLE_EQ(found.black_level_dn, 40 + 25);
    EXPECT_DOUBLE_EQ(found.read_noise_e, std::sqrt(100 + 50));
    const FrameShape shape{.rows = 128, .cols = 512, .planes = 1};
    const auto full = full_schedule(1, 1);
    CodedSensor sensor(params, shape, full, kSeed);
    SamplePacket packet;
    sensor.expose(std::vector<float>(shape.sites()), packet);
    double mean = 0;
    for (const auto dn : packet.dn) mean += static_cast<double>(dn) / 65536;
    // 127 / 256 of 100 e. The mean of 65536 samples scatters by 0.03 DN; 5 of that.
    EXPECT_NEAR(mean, 40 + 25 * 127.0 / 128, 0.15);
}

}  // namespace
}  // namespace stipple
