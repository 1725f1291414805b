#include "study/explore/point_view.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "tests/support/memory_file.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr const char* kTwo =
    "sensors = ['a', 'b']\n[a]\nshare = 0.5\n[b]\nseed = 7\nshare = 0.5\n"
    "set = ['sensor.bit_depth=10']\n";

/// The point of a space with a rig of this text.
PointRig found(const std::string& rig, const std::string& axes, const std::string& set = "") {
    const MemoryFile file(rig);
    const Space space = parse_space("[axes]\nsensor = 'ideal'\nrig = '" + file.path().string() +
                                        "'\n" + axes + "\n[set]\n" + set,
                                    "space.toml");
    return rig_of(space, space.point(0));
}

std::string problem_of(const std::string& rig, const std::string& axes,
                       const std::string& set = "") {
    return message_of<InputError>([&] { static_cast<void>(found(rig, axes, set)); });
}

TEST(PointRigTest, SensorsThatNameNoneHaveThatOfThePoint) {
    const Rig rig = found(kTwo, "").rig;
    ASSERT_EQ(rig.sensors.size(), 2U);
    for (const RigSensor& sensor : rig.sensors) EXPECT_EQ(sensor.choice.sensor, "ideal");
    EXPECT_EQ(found("sensors = ['a']\na.sensor = 'ideal'\n", "").rig.sensors.size(), 1U);
    expect_parts(problem_of("sensors = ['a']\na.sensor = 'paper'\n", ""),
                 {":2: a.sensor", "is \"paper\"", "axes.sensor \"ideal\"", "without the key"});
}

TEST(PointRigTest, SeedsOfThePointAreApart) {
    EXPECT_EQ(found(kTwo, "seed = 1").rig.sensors[1].choice.seed, 7U);
    EXPECT_EQ(found(kTwo, "seed = 3").rig.sensors[0].choice.seed, 1U + 2 * Rig::kMaxSensors);
    EXPECT_EQ(found(kTwo, "seed = 3").rig.sensors[1].choice.seed, 7U + 2 * Rig::kMaxSensors);
}

TEST(PointRigTest, KeysOfSensorsChangeAllAndKeysOfTheRigOne) {
    const Rig rig = found(kTwo, "", "'sensor.read_noise_e' = 3\n'rig.a.share' = 0.25\n").rig;
    EXPECT_EQ(rig.sensors[0].choice.settings, std::vector<std::string>{"read_noise_e=3"});
    EXPECT_EQ(rig.sensors[1].choice.settings,
              (std::vector<std::string>{"bit_depth=10", "read_noise_e=3"}));
    EXPECT_EQ(rig.sensors[0].share, 0.25);
    EXPECT_EQ(rig.sensors[1].share, 0.5);
    expect_parts(problem_of(kTwo, "", "'schedule.open_slots' = 3\n"),
                 {"set.schedule.open_slots", "one sensor", "rig.NAME.set"});
    expect_parts(problem_of(kTwo, "", "'rig.a.shares' = 3\n"), {"rig.a.shares", "unknown"});
}

TEST(PointRigTest, TheKeysAreThoseOfTheFileWithoutComments) {
    const std::string keys = found(kTwo, "").keys;
    EXPECT_EQ(found(std::string("# a comment\n") + kTwo, "").keys, keys);
    EXPECT_NE(found(std::string(kTwo) + "phase_slots = 1\n", "").keys, keys);
    EXPECT_NE(found(kTwo, "", "'rig.a.share' = 0.25\n").keys, keys);
}

TEST(PointRigTest, APointWithoutRigHasOneSensor) {
    const Space space = parse_space(
        "[axes]\nsensor = 'ideal'\nseed = 5\nschedule = 'full4x'\n[set]\n"
        "'sensor.bit_depth' = 9\n'schedule.open_slots' = 2\n",
        "space.toml");
    const PointRig point = rig_of(space, space.point(0));
    ASSERT_EQ(point.rig.sensors.size(), 1U);
    EXPECT_TRUE(point.keys.empty());
    const RigSensor& sensor = point.rig.sensors.front();
    EXPECT_EQ(sensor.share, 1);
    EXPECT_EQ(sensor.choice.sensor, "ideal");
    EXPECT_EQ(sensor.choice.schedule, "full4x");
    EXPECT_EQ(sensor.choice.seed, 5U);
    EXPECT_EQ(sensor.choice.settings, std::vector<std::string>{"bit_depth=9"});
    EXPECT_EQ(sensor.choice.schedule_settings, std::vector<std::string>{"open_slots=2"});
    const Space rigless =
        parse_space("[axes]\nsensor = 'ideal'\n[set]\n'rig.a.share' = 0.5\n", "space.toml");
    expect_parts(
        message_of<InputError>([&] { static_cast<void>(rig_of(rigless, rigless.point(0))); }),
        {"set.rig.a.share", "is a key of a rig"});
}

}  // namespace
}  // namespace stipple
