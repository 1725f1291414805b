#include "readout/rig.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "readout/sensor_file.h"
#include "tests/support/memory_file.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 16, .cols = 24, .planes = 1};

Rig rig_of(const std::string& text) {
    const MemoryFile file(text);
    Config config(file.path(), {}, "rig");
    return read_rig(config);
}

std::string problem_of(const std::string& text) {
    return message_of<InputError>([&] { static_cast<void>(rig_of(text)); });
}

std::string setup_problem_of(const std::string& text, ColourFilter filter = ColourFilter::kNone) {
    return message_of<InputError>(
        [&] { static_cast<void>(set_up_rig(rig_of(text), kShape, filter)); });
}

TEST(RigTest, ReadsItsSensorsInTheirOrder) {
    const Rig rig = rig_of(
        "name = 'two'\nsensors = ['b', 'a']\n[a]\nshare = 0.25\nphase_slots = 3\n"
        "offset_px = [1.5, -2]\nset = ['sensor.bit_depth=10', 'schedule.open_slots=2']\n"
        "schedule = 'full4x'\n[b]\nshare = 0.75\nseed = 9\n");
    EXPECT_EQ(rig.name, "two");
    ASSERT_EQ(rig.sensors.size(), 2U);
    EXPECT_EQ(rig.sensors[0].name, "b");
    EXPECT_EQ(rig.sensors[0].choice.seed, 9U);
    const RigSensor& a = rig.sensors[1];
    EXPECT_EQ(a.choice.seed, 2U);  // by its number
    EXPECT_EQ(a.share, 0.25);
    EXPECT_EQ(a.phase_slots, 3);
    EXPECT_EQ(a.from_reference, Homography::shift({.row = 1.5, .col = -2}));
    EXPECT_EQ(a.choice.settings, std::vector<std::string>{"bit_depth=10"});
    EXPECT_EQ(a.choice.schedule_settings, std::vector<std::string>{"open_slots=2"});
}

TEST(RigTest, ASensorThatNamesNoneIsTheDefault) {
    const MemoryFile file(
        "sensors = ['a', 'b']\nb.sensor = 'lux1310'\na.share = 0.5\nb.share = 0.5");
    Config config(file.path(), {});
    const Rig rig = read_rig(config, "ideal");
    EXPECT_EQ(rig.sensors[0].choice.sensor, "ideal");
    EXPECT_EQ(rig.sensors[1].choice.sensor, "lux1310");
}

TEST(RigTest, SharesAreSettingsOfTheSensors) {
    const auto setups =
        set_up_rig(rig_of("sensors = ['a', 'b']\na.share = 0.75\nb.share = 0.25"), kShape);
    EXPECT_EQ(setups[0].params.photons_per_unit, 750);
    EXPECT_EQ(setups[1].params.photons_per_unit, 250);
    ASSERT_TRUE(setups[1].origin);  // so that the provenance names all there is
    EXPECT_EQ(setups[1].origin->settings, std::vector<std::string>{"photons_per_unit=250"});
}

TEST(RigTest, AShareIsOfTheLightThatSettingsGiveASensor) {
    const auto setups = set_up_rig(
        rig_of("sensors = ['a']\na = { share = 0.25, set = ['sensor.photons_per_unit=400'] }"),
        kShape);
    EXPECT_EQ(setups.front().params.photons_per_unit, 100);
}

TEST(RigTest, ShippedRigsAreUsable) {
    for (const std::string& name : config_names(ConfigKind::kRigs)) {
        Config config(find_config(ConfigKind::kRigs, name), {});
        const Rig rig = read_rig(config);
        EXPECT_EQ(rig.name, name);
        EXPECT_EQ(set_up_rig(rig, kShape).size(), rig.sensors.size());
    }
    EXPECT_GE(config_names(ConfigKind::kRigs).size(), 4U);
}

TEST(RigTest, RefusesWhatNoRigIs) {
    expect_parts(problem_of("name = 'x'"), {"sensors", "names no sensor"});
    expect_parts(problem_of("sensors = ['a', 'a']"), {"two sensors \"a\""});
    expect_parts(problem_of("sensors = ['../a']"), {"\"../a\" is not a name"});
    expect_parts(problem_of("sensors = ['a']\n[b]\nshare = 1"), {":3: b.share", "unknown"});
    expect_parts(problem_of("sensors = ['a', 'b']\na.share = 0.7\nb.share = 0.4"),
                 {":3: b.share", "sum 1.1", "aperture"});
    EXPECT_EQ(
        rig_of("sensors = ['a', 'b']\naperture = 'own'\na.share = 1\nb.share = 0.4").sensors.size(),
        2U);
    expect_parts(problem_of("sensors = ['a']\na.share = 0"), {"a.share", "outside"});
    expect_parts(problem_of("sensors = ['a']\na.set = ['bit_depth=3']"), {"a.set", "sensor."});
    expect_parts(problem_of("sensors = ['a', 'b']\nb.homography = [1, 0, 0, 2, 0, 0, 0, 0, 1]\n"
                            "a.share = 0.5\nb.share = 0.5"),
                 {"b.homography", "singular"});
    expect_parts(problem_of("sensors = ['a']\na.homography = [1, 0]"), {"2 numbers, not 9"});
    expect_parts(problem_of("sensors = ['a']\na.offset_px = [1, 0, 2]"), {"3 numbers"});
    expect_parts(problem_of("sensors = ['a', 'b']\nb.offset_px = [1, 0]\n"
                            "b.homography = [1, 0, 0, 0, 1, 0, 0, 0, 1]"),
                 {"b.offset_px", "leave out one"});
    expect_parts(problem_of("sensors = ['a']\na.offset_px = [1, 0]"), {"a.offset_px", "reference"});
    expect_parts(problem_of("sensors = ['a']\na.phase_slots = 2"), {"a.phase_slots", "reference"});
}

TEST(RigTest, RefusesSensorsThatDoNotBelongTogether) {
    const std::string two = "sensors = ['a', 'b']\na.share = 0.5\nb.share = 0.5\n";
    expect_parts(setup_problem_of(two + "b.offset_px = [16, 0]"), {"\"b\"", "sees no pixel"});
    expect_parts(setup_problem_of(two + "b.homography = [1, 0, 0, 0, 1, 0, -0.1, 0, 1]"),
                 {"\"b\"", "infinity"});
    expect_parts(setup_problem_of(two + "b.set = ['sensor.slot_us=1000']"),
                 {"\"b\"", "slot_us 1000", "5000"});
    expect_parts(setup_problem_of(two + "b.offset_px = [2, 0]", ColourFilter::kRggb),
                 {"\"b\"", "mosaic"});
    expect_parts(setup_problem_of(two + "b.sensor = 'nosuch'"), {"nosuch"});
}

}  // namespace
}  // namespace stipple
