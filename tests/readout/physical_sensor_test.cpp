// The chip in physical mode: what PhysicalPixels and ColumnAdc get from the schedule.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/flux_video.h"
#include "core/parallel.h"
#include "readout/coded_sensor.h"
#include "readout/column_adc.h"
#include "sensor_model/physical_pixels.h"
#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

constexpr std::uint64_t kSeed = 3;
constexpr FrameShape kShape{.rows = 37, .cols = 53, .planes = 2};
constexpr int kSlots = 40;

SensorParams physical() {
    return {.full_scale_e = 4000,
            .bit_depth = 10,
            .mode = SensorMode::kPhysical,
            .physical = {.quantum_efficiency = 0.6,
                         .dark_current_e_per_s = 4000,
                         .dsnu_e = 4,
                         .prnu = 0.02,
                         .row_noise_e = {5},
                         .black_level_dn = 20,
                         .dnl_dn = 0.5,
                         .device_id = 9,
                         .map_cols = 2,
                         .gain_map = {1, 4}}};
}

FluxVideo ramps() {
    FluxVideo video(kSlots, kShape);
    for (std::size_t i = 0; i < video.voxels(); ++i)
        video.data()[i] = static_cast<float>(i % 1009) / 512;
    return video;
}

using Slots = std::vector<std::vector<std::uint16_t>>;

Slots expose_all(const FluxVideo& video, const ExposureSchedule& schedule,
                 const SensorParams& params) {
    CodedSensor sensor(params, video.shape(), schedule, kSeed);
    SamplePacket packet;
    Slots dn;
    for (int slot = 0; slot < video.slots(); ++slot) {
        sensor.expose(video.frame(slot), packet);
        dn.push_back(packet.dn);
    }
    return dn;
}

/// The slow, obvious sensor: one exposure after the other.
Slots expose_one_by_one(const FluxVideo& video, const ExposureSchedule& schedule,
                        const SensorParams& params) {
    const PhysicalPixels pixels(params, kShape, kSeed);
    const ColumnAdc adc(params);
    Slots dn(kSlots);
    for (int row = 0; row < kShape.rows; ++row)
        for (int col = 0; col < kShape.cols; ++col)
            for (const auto& taken : taken_exposures(schedule, row, col, kSlots)) {
                if (taken.last_slot() >= kSlots) continue;
                for (std::uint32_t plane = 0; plane < 2; ++plane) {
                    float light = 0;
                    for (int i = 0; i < taken.exposure.span_slots(); ++i)
                        if ((taken.exposure.open_slots >> static_cast<unsigned>(i) & 1U) != 0)
                            light += video.plane(static_cast<int>(taken.begin_slot) + i,
                                                 static_cast<int>(plane))(row, col);
                    const auto pixel = static_cast<std::uint32_t>(row * kShape.cols + col);
                    const auto slots = static_cast<std::uint16_t>(taken.exposure.light_slots());
                    float electrons = 0;
                    pixels.expose({{&pixel, 1}, {&light, 1}, {&slots, 1}},
                                  static_cast<std::uint32_t>(taken.last_slot()), plane,
                                  {.electrons = {&electrons, 1}});
                    dn[static_cast<std::size_t>(taken.last_slot())].push_back(
                        adc.convert_one(electrons));
                }
            }
    return dn;
}

TEST(PhysicalSensorTest, IsTheSlowSensorWithAndWithoutGaps) {
    const FluxVideo video = ramps();
    for (const auto& schedule : {gapped_schedule(3, 5, 29, 1), gapped_schedule(7, 4, 16, 2),
                                 random_schedule(37, 53, kPaperExposureSlots, 1)})
        EXPECT_EQ(expose_all(video, schedule, physical()),
                  expose_one_by_one(video, schedule, physical()));
}

TEST(PhysicalSensorTest, GivesTheSameBitsForAnyNumberOfThreads) {
    const auto schedule = random_schedule(37, 53, kPaperExposureSlots, 1);
    const auto with_threads = [&](int threads) {
        const ThreadLimit limit(threads);
        return expose_all(ramps(), schedule, physical());
    };
    EXPECT_EQ(with_threads(1), with_threads(2));
}

TEST(PhysicalSensorTest, KeepsItsPatternAndChangesItsNoiseWithTheSeed) {
    SensorParams params = physical();
    params.shot_noise = false;
    params.read_noise_e = 0;
    params.physical.row_noise_e = {};
    const ExposureSchedule schedule(1, 1, 1, {0, 1}, {{0, 1}});
    const FluxVideo video = ramps();
    const auto with = [&](std::uint64_t seed, const SensorParams& p) {
        CodedSensor sensor(p, kShape, schedule, seed);
        SamplePacket packet;
        sensor.expose(video.frame(0), packet);
        return packet.dn;
    };
    EXPECT_EQ(with(1, params), with(2, params));
    EXPECT_NE(with(1, physical()), with(2, physical()));
    SensorParams other = params;
    other.physical.device_id = 10;
    EXPECT_NE(with(1, params), with(1, other));
}

TEST(PhysicalSensorTest, WithoutTermsIsThePapersSensorBitByBit) {
    SensorParams params;
    const auto schedule = gapped_schedule(3, 5, 29, 1);
    const Slots paper = expose_all(ramps(), schedule, params);
    params.mode = SensorMode::kPhysical;
    EXPECT_EQ(expose_all(ramps(), schedule, params), paper);
}

TEST(PhysicalSensorTest, TakesInfiniteLightAsSaturation) {
    FluxVideo video(8, {.rows = 2, .cols = 2, .planes = 1});
    std::ranges::fill(video.data(), std::numeric_limits<float>::infinity());
    SensorParams params = physical();
    params.physical.gain_map = {2, 4};
    params.physical.inl_dn = 3;
    for (const auto& dn : expose_all(video, gapped_schedule(1, 3, 8, 1), params))
        for (const std::uint16_t value : dn) EXPECT_EQ(value, 1023);
}

SensorParams converter(double black_level_dn, double inl_dn, double dnl_dn) {
    return {.full_scale_e = 1023,
            .bit_depth = 10,
            .mode = SensorMode::kPhysical,
            .physical = {.black_level_dn = black_level_dn, .inl_dn = inl_dn, .dnl_dn = dnl_dn}};
}

TEST(PhysicalAdcTest, PutsTheBlackLevelUnderTheCharge) {
    const ColumnAdc adc(converter(64, 0, 0));
    EXPECT_EQ(adc.convert_one(0), 64);
    EXPECT_EQ(adc.convert_one(-60), 4);
    EXPECT_EQ(adc.convert_one(-70), 0);
    EXPECT_EQ(adc.convert_one(500.5F), 565);
    EXPECT_EQ(adc.convert_one(959), 1023);
    EXPECT_EQ(adc.convert_one(2000), 1023);
}

TEST(PhysicalAdcTest, BendsTheCurveByTheGivenPeak) {
    const ColumnAdc straight(converter(0, 0, 0)), bent(converter(0, 20, 0));
    int largest = 0;
    for (int e = 0; e <= 1023; ++e) {
        const int error =
            bent.convert_one(static_cast<float>(e)) - straight.convert_one(static_cast<float>(e));
        largest = std::max(largest, error);
        EXPECT_GE(error, 0);
        if (e > 0) {
            EXPECT_GE(bent.convert_one(static_cast<float>(e)),
                      bent.convert_one(static_cast<float>(e - 1)));
        }
    }
    EXPECT_EQ(largest, 20);
    EXPECT_EQ(bent.convert_one(0), 0);
    EXPECT_EQ(bent.convert_one(1023), 1023);
    EXPECT_EQ(bent.convert_one(511.5F), 532);  // 511.5 + 20, rounded up
}

TEST(PhysicalAdcTest, MovesEachStepByLessThanHalfTheLargestError) {
    for (const double dnl_dn : {0.1, 0.5}) {
        const ColumnAdc adc(converter(0, 0, dnl_dn));
        double largest = 0;
        std::vector<double> step(1024);
        for (int fine = 1, dn = 0; fine < 1023 * 512; ++fine) {
            const int found = adc.convert_one(static_cast<float>(fine) / 512);
            ASSERT_TRUE(found == dn || found == dn + 1) << fine;
            if (found > dn) step[static_cast<std::size_t>(dn = found)] = fine / 512.0;
        }
        for (int dn = 1; dn <= 1023; ++dn) {
            const double error = step[static_cast<std::size_t>(dn)] - (dn - 0.5);
            EXPECT_LE(std::abs(error), dnl_dn / 2 + 1 / 512.0);
            largest = std::max(largest, std::abs(error));
        }
        EXPECT_GT(largest, 0.95 * dnl_dn / 2);
    }
}

}  // namespace
}  // namespace stipple
