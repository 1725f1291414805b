#include "readout/rig_recorder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "core/error.h"
#include "readout/sensor_file.h"
#include "stream/stream_reader.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 4, .cols = 6, .planes = 1};

/// Light that is 0 but at one pixel.
std::vector<float> spot(int row, int col) {
    std::vector<float> frame(kShape.sites());
    frame[static_cast<std::size_t>(row * kShape.cols + col)] = 1;
    return frame;
}

TEST(RigRecorderTest, SeesTheMovedLightFromItsFirstSlotOn) {
    const TemporaryFolder folder;
    const RigSensor sensor{.name = "a",
                           .choice = SensorChoice{.sensor = "ideal", .schedule = "full1x"},
                           .from_reference = Homography::shift({.row = 1, .col = 2}),
                           .phase_slots = 2};
    const SensorSetup setup = set_up_sensor(sensor.choice, kShape);
    RigRecorder recorder(sensor, setup, folder / "a.stipple");
    for (int slot = 0; slot < 5; ++slot)  // the spot moves by a column a slot
        recorder.expose(slot, spot(1, slot));
    recorder.finish(5);
    EXPECT_EQ(recorder.recorder().emulator().stats().slots, 3);

    StreamReader reader(folder / "a.stipple", ReadPolicy::kStrict);
    SamplePacket packet;
    ASSERT_TRUE(reader.next(packet));
    ASSERT_EQ(packet.dn.size(), kShape.sites());
    // In its slot 0, slot 2 of the footage, the spot of (1, 2) is at (1, 2) + (1, 2).
    for (std::size_t i = 0; i < packet.dn.size(); ++i)
        EXPECT_EQ(packet.dn[i] > 0, i == 2U * 6 + 4) << i;
}

TEST(RigRecorderTest, FootageThatEndsBeforeItsFirstSlotIsRefused) {
    const TemporaryFolder folder;
    const RigSensor sensor{.name = "late", .choice = {}, .phase_slots = 3};
    const SensorSetup setup = set_up_sensor(sensor.choice, kShape);
    {
        RigRecorder recorder(sensor, setup, folder / "a.stipple");
        for (int slot = 0; slot < 3; ++slot) recorder.expose(slot, spot(0, 0));
        expect_parts(message_of<InputError>([&] { recorder.finish(3); }),
                     {"sensor \"late\" of the rig", "begins at slot 3", "has 3 slots"});
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "a.stipple"));
}

}  // namespace
}  // namespace stipple
