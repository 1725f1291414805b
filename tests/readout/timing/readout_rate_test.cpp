#include "readout/timing/readout_rate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "core/error.h"
#include "readout/schedules/hardware_tiled.h"
#include "readout/schedules/schedule_catalogue.h"
#include "readout/schedules/tiled_schedule.h"
#include "readout/timing/readout_cost.h"
#include "sensor_model/sensor_config.h"
#include "tests/readout/timing/random_readout.h"
#include "tests/readout/timing/sensor_timing.h"

namespace stipple {
namespace {

TEST(ReadoutRateTest, AConventionalCameraHasItsPublishedFrameRate) {
    const auto timing = sensor_timing("lux1310");
    const auto rate = rate_of(timing, full_schedule(4, 4), {1024, 1280, 1}, 0);
    EXPECT_EQ(rate.full.total, 84143);
    EXPECT_EQ(rate.slowest.counts.readout_clocks, 84143);
    EXPECT_EQ(rate.slowest_phase, 3);
    EXPECT_EQ(rate.deadline_slots, 4);
    EXPECT_NEAR(rate.full_hz, 1069.6, 0.1);
    // A frame of 4 slots is transferred while the next one is exposed.
    EXPECT_DOUBLE_EQ(rate.min_slot_clocks, 84143 / 4.0);
    EXPECT_DOUBLE_EQ(rate.speedup, 4);
    EXPECT_DOUBLE_EQ(rate.mean_slot_clocks, 84143 / 4.0);
    EXPECT_NEAR(rate.full_energy_pj, 1024 * (100 + 1280 * (4 * 100 + 12 * 10.0)),
                1);  // config/sensors/lux1310.toml; 12 bits cost four times as much as 10
}

// What must hold on the sold chip, whatever is coded: 1069.6 frames/s are 4278 slots of which one
// in four begins a frame.
TEST(ReadoutRateTest, FramesOfFourSlotsRunAtTheFrameRateOfTheChip) {
    const auto timing = sensor_timing("lux1310");
    const FrameShape shape{1024, 1280, 1};
    const auto slots_hz = [&](const char* name) {
        Config config(project_path("config/schedules") / (std::string(name) + ".toml"), {});
        const auto named = read_schedule(config, shape, 1, timing.addressing);
        return rate_of(timing, named.schedule, shape, 0).coded_hz;
    };
    EXPECT_NEAR(slots_hz("full1x"), 4 * 1069.6, 0.2);
    EXPECT_NEAR(slots_hz("full4x"), 4 * 1069.6, 0.2);
    EXPECT_NEAR(slots_hz("rolling"), 4252, 0.5);
    EXPECT_NEAR(slots_hz("random"), 2860, 5);
    EXPECT_NEAR(slots_hz("hardware_tiled"), 3500, 0.5);
}

// Its frame time is the sum of exposure and readout, as in the data sheets of such sensors.
TEST(ReadoutRateTest, AChipThatCannotExposeWhileItReadsTakesTheSum) {
    auto timing = sensor_timing("lux1310");
    timing.exposes_while_reading = false;
    const FrameShape shape{1024, 1280, 1};
    constexpr std::int64_t kExposure = 45000;
    EXPECT_DOUBLE_EQ(rate_of(timing, full_schedule(4, 4), shape, kExposure).min_slot_clocks,
                     (4 * kExposure + 84143) / 4.0);
    EXPECT_DOUBLE_EQ(rate_of(timing, full_schedule(1, 4), shape, kExposure).min_slot_clocks,
                     (kExposure + 84143) / 4.0);
    const auto coded = random_schedule(64, 1280, kPaperExposureSlots, 1);
    const ReadoutRate rate = rate_of(timing, coded, shape, kExposure);
    EXPECT_EQ(rate.deadline_slots, 0);
    EXPECT_DOUBLE_EQ(rate.min_slot_clocks,
                     static_cast<double>(kExposure + rate.slowest.counts.readout_clocks));
    EXPECT_DOUBLE_EQ(rate.mean_slot_clocks,
                     kExposure + static_cast<double>(rate.period.readout_clocks) / 15);
}

// Slots of the rate lose nothing; slots that are shorter by a clock, and shorter than the rate, do.
TEST(ReadoutRateTest, IsTheFastestWithoutOverrun) {
    int tested = 0;
    for (std::uint32_t seed = 0; seed < 1000; ++seed) {
        Draw draw(seed);
        ReadoutTiming timing = random_timing(draw);
        timing.overhead_clocks += 20;
        const FrameShape shape{timing.rows, timing.cols, 1};
        const ExposureSchedule schedule = random_frames(draw);
        const auto overruns = [&](std::int64_t budget, int slots) {
            ReadoutCost cost(timing, schedule, shape, {budget, OverrunPolicy::kStretch});
            while (cost.slots() < slots && cost.overruns() == 0) cost.add_next();
            return cost.overruns();
        };
        const double slot_clocks = rate_of(timing, schedule, shape, 0).min_slot_clocks;
        const auto whole = static_cast<std::int64_t>(std::ceil(slot_clocks));
        EXPECT_EQ(overruns(whole, 200), 0) << "seed " << seed;
        if (whole == 1) continue;
        EXPECT_GT(overruns(whole - 1, 20000), 0) << "seed " << seed;
        ++tested;
    }
    EXPECT_GT(tested, 900);
}

// docs/readout_timing.md: per-pixel random codes on a LUX1310 with channels that skip columns take
// about 31 of the 82 clocks of a row, evenly spread ones 23.3.
TEST(ReadoutRateTest, RandomCodesOnLux1310TakeTheDocumentedTime) {
    const auto timing = sensor_timing("lux1310");
    const FrameShape shape{256, 1280, 1};
    const auto rate = rate_of(timing, random_schedule(256, 1280, kPaperExposureSlots, 1), shape, 0);
    EXPECT_NEAR(rate.balanced.row, 80 * 4.0 / 15 + 2, 1e-9);
    EXPECT_NEAR(rate.speedup, 82 / 31.0, 0.1);
    EXPECT_GT(rate.balanced_speedup, 3.3);
    EXPECT_LT(rate.speedup, rate.balanced_speedup);
}

// docs/hardware_schedules.md: gains of whole arrays, rounded there to two digits.
TEST(ReadoutRateTest, GainsAreThoseOfTheDocumentedTable) {
    struct Row {
        const char* sensor;
        const char* addressing;
        double random, tiled, hardware_tiled, bound;
    };
    for (const Row& row : {Row{"lux1310", "skip_channel", 2.67, 1.00, 3.27, 3.50},
                           {"lux1310", "group", 1.00, 1.00, 3.50, 3.50},
                           {"lux2100", "skip_channel", 2.43, 1.00, 2.45, 2.45},
                           {"lux2100", "group", 1.00, 1.00, 2.45, 2.45},
                           {"imx273", "skip_channel", 1.51, 1.17, 1.51, 1.51},
                           {"imx273", "group", 1.00, 1.00, 1.51, 1.51},
                           {"vita", "skip_channel", 2.36, 1.59, 2.47, 2.49},
                           {"vita", "group", 1.30, 1.24, 2.49, 2.49},
                           {"plc720", "skip_channel", 2.53, 2.53, 2.54, 2.54},
                           {"plc720", "group", 1.07, 1.00, 2.54, 2.54}}) {
        SCOPED_TRACE(testing::Message() << row.sensor << ' ' << row.addressing);
        const auto timing =
            sensor_timing(row.sensor, {std::string("timing.addressing=") + row.addressing});
        const FrameShape shape{timing.rows, timing.cols, 1};
        const HardwareTile tile{.addressing = timing.addressing, .array_cols = timing.cols};
        const auto gain = [&](const ExposureSchedule& schedule) {
            const ReadoutRate rate = rate_of(timing, schedule, shape, 0);
            EXPECT_NEAR(rate.balanced_speedup, row.bound, 0.005);
            return rate.speedup;
        };
        EXPECT_NEAR(gain(random_schedule(256, shape.cols, kPaperExposureSlots, 1)), row.random,
                    0.005);
        EXPECT_NEAR(gain(tiled_schedule(16, 16, kPaperExposureSlots, 1)), row.tiled, 0.005);
        EXPECT_NEAR(gain(hardware_tiled_schedule(tile, kPaperExposureSlots, 1)), row.hardware_tiled,
                    0.005);
    }
}

// With groups of 16 x 2 pixels, nearly every group has some pixel due: all is transferred.
TEST(ReadoutRateTest, RandomCodesGainNothingInGroupsOf16By2) {
    const auto timing = sensor_timing("lux1310", {"timing.addressing=group"});
    const FrameShape shape{128, 1280, 1};
    const auto rate = rate_of(timing, random_schedule(128, 1280, kPaperExposureSlots, 1), shape, 0);
    EXPECT_NEAR(rate.speedup, 1, 0.01);
}

// A tile of one row and 15 columns on 3 channels, where pixel c is due in slot c: in each slot a
// single channel has all the columns to read. With 4 channels they share them.
TEST(ReadoutRateTest, ATileInStepWithTheChannelsIsSlow) {
    std::vector<Exposure> exposures;
    std::vector<std::uint32_t> first{0};
    for (std::uint32_t col = 0; col < 15; ++col) {
        exposures.push_back({col, 1});
        first.push_back(col + 1);
    }
    const ExposureSchedule schedule(1, 15, 15, first, exposures);
    ReadoutTiming timing;
    timing.clock_hz = 1000;
    timing.rows = 1;
    timing.cols = 60;
    timing.addressing.channels = 3;
    EXPECT_EQ(rate_of(timing, schedule, {1, 60, 1}, 0).min_slot_clocks, 4);
    timing.addressing.channels = 4;
    EXPECT_EQ(rate_of(timing, schedule, {1, 60, 1}, 0).min_slot_clocks, 1);
}

bool reads_every_row(const ReadoutTiming& timing, const ExposureSchedule& schedule,
                     FrameShape shape) {
    std::vector<RowLoad> loads;
    const auto all_rows = static_cast<std::size_t>(shape.rows + timing.dark_rows);
    RowLoads row_loads(timing, schedule, shape);
    const int period = schedule.period_slots();
    for (int slot = period; slot < 2 * period; ++slot) {
        row_loads.list(slot, loads);
        if (loads.size() != all_rows) return false;
    }
    return true;
}

TEST(ReadoutRateTest, NoScheduleThatReadsEveryRowBeatsTheBound) {
    int tested = 0;
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        Draw draw(seed);
        ReadoutTiming timing = random_timing(draw);
        const FrameShape shape{draw(1, timing.rows), timing.cols, 1};
        const auto schedule = random_schedule(draw(1, 5), timing.cols, std::vector{1, 2, 1}, seed);
        // A chip that settles less for fewer columns may gain by uneven rows.
        if (!timing.settle_clocks.empty() || !reads_every_row(timing, schedule, shape)) continue;
        const auto rate = rate_of(timing, schedule, shape, 0);
        EXPECT_LE(rate.speedup, rate.balanced_speedup * (1 + 1e-12)) << "seed " << seed;
        ++tested;
    }
    EXPECT_GT(tested, 30);
}

// All sensors of config/sensors with a timing, in windows whose mean loads are no whole numbers;
// codes made for the hardware come nearest to the bound.
TEST(ReadoutRateTest, NoSensorBeatsTheBound) {
    int tested = 0;
    for (const auto& file : std::filesystem::directory_iterator(project_path("config/sensors")))
        for (const auto kind :
             {ColumnAddressing::Kind::kSkipChannel, ColumnAddressing::Kind::kGroup}) {
            Config config(file.path(), {});
            const SensorParams params = read_sensor(config);
            auto timing = read_timing(config, params.bit_depth);
            if (!timing) continue;
            timing->addressing.kind = kind;
            for (const FrameShape shape : {FrameShape{128, 128, 1}, FrameShape{64, 320, 1}})
                for (const char* name : {"random", "tiled", "hardware_tiled"}) {
                    Config schedule(
                        project_path("config/schedules") / (std::string(name) + ".toml"), {});
                    const auto made = read_schedule(schedule, shape, 1, timing->addressing);
                    if (!reads_every_row(*timing, made.schedule, shape)) continue;
                    const auto rate = rate_of(*timing, made.schedule, shape, 0);
                    EXPECT_LE(rate.speedup, rate.balanced_speedup * (1 + 1e-12))
                        << file.path().filename() << " " << name << " " << shape.cols;
                    ++tested;
                }
        }
    EXPECT_GT(tested, 60);
}

TEST(ReadoutRateTest, AScheduleThatReadsNothingIsRefused) {
    const ExposureSchedule nothing(1, 1, 1, {0, 0}, {});
    EXPECT_THROW(static_cast<void>(rate_of(sensor_timing("vita"), nothing, {4, 4, 1}, 0)),
                 InputError);
}

}  // namespace
}  // namespace stipple
