#include "readout/sensor_switch.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <thread>

#include "core/error.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 16, .cols = 16};

TEST(SensorSwitchTest, ChangesAreLaidOverTheSensor) {
    SensorChoice choice{.schedule = "random", .schedule_settings = {"exposure_slots=[1]"}};
    change_sensor("seed=7,sensor.full_scale_e=400", choice);
    EXPECT_EQ(choice.schedule, "random");
    EXPECT_EQ(choice.seed, 7U);
    EXPECT_EQ(choice.settings, std::vector<std::string>{"full_scale_e=400"});
    EXPECT_EQ(choice.schedule_settings.size(), 1U);
    change_sensor("schedule=tiled,schedule.exposure_slots=[1,2],schedule.tile_rows=4", choice);
    EXPECT_EQ(choice.schedule, "tiled");
    EXPECT_EQ(choice.schedule_settings,
              (std::vector<std::string>{"exposure_slots=[1,2]", "tile_rows=4"}));
}

TEST(SensorSwitchTest, OtherChangesAreRefused) {
    SensorChoice choice;
    for (const char* text : {"", "schedule", "seed=", "seed=-1", "seed=x", "gain=1", "seed=1,"})
        EXPECT_THROW(change_sensor(text, choice), InputError) << text;
}

TEST(SensorControlTest, AChangeWaitsForTheEmulation) {
    const SensorChoice choice{.schedule = "tiled"};
    const SensorSetup setup = set_up_sensor(choice, kShape);
    SensorControl control(choice, setup, ColourFilter::kNone);
    std::optional<SensorSetup> switched;
    std::atomic<bool> changed = false;
    std::thread emulation([&] {
        for (std::int64_t slot = 0; !changed; ++slot)
            control.apply([&](const SensorSetup& next) {
                switched = next;
                return slot;
            });
    });
    EXPECT_GE(control.change("schedule=full4x,seed=3,sensor.full_scale_e=400"), 0);
    changed = true;
    emulation.join();
    ASSERT_TRUE(switched);
    EXPECT_EQ(switched->schedule.name, "full4x");
    EXPECT_EQ(switched->params.full_scale_e, 400);
    EXPECT_EQ(switched->seed, setup.seed);  // the noise goes on
    EXPECT_EQ(control.choice().schedule, "full4x");
    EXPECT_EQ(control.choice().seed, 3U);
}

TEST(SensorControlTest, ARefusedChangeLeavesTheSensor) {
    const SensorChoice choice{.schedule = "tiled"};
    const SensorSetup setup = set_up_sensor(choice, kShape);
    SensorControl control(choice, setup, ColourFilter::kNone);
    EXPECT_THROW(control.change("schedule=no_such"), InputError);
    std::atomic<bool> done = false;
    std::thread emulation([&] {
        while (!done)
            control.apply([](const SensorSetup&) -> std::int64_t {
                throw InputError("switch", "is not possible");
            });
    });
    EXPECT_THROW(control.change("seed=2"), InputError);
    done = true;
    emulation.join();
    EXPECT_EQ(control.choice().seed, 1U);
}

TEST(SensorControlTest, NobodyWaitsForAnEmulationThatHasEnded) {
    const SensorSetup setup = set_up_sensor({}, kShape);
    SensorControl control({}, setup, ColourFilter::kNone);
    std::thread page([&] { EXPECT_THROW(control.change("seed=2"), DeviceError); });
    control.end();
    page.join();
    EXPECT_THROW(control.change("seed=2"), DeviceError);
}

}  // namespace
}  // namespace stipple
