#include "view/recent_slots.h"

#include <gtest/gtest.h>

#include <vector>

#include "decoder/measurements.h"
#include "io/pixel_format.h"
#include "readout/emulator.h"
#include "readout/sensor_file.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 16, .cols = 16};
constexpr int kSlots = 130;

/// So large that the least number of slots is kept, 48.
FrameLayout large_layout() {
    return {.format = pixel_format_named("Mono8"),
            .width = kShape.cols,
            .height = kShape.rows,
            .stride_bytes = std::size_t{200} << 10U};
}

SensorSetup tiled(std::uint64_t seed) {
    return set_up_sensor({.schedule = "tiled", .seed = seed}, kShape);
}

TEST(RecentSlotsTest, SwitchesBeforeTheSlotsThatAreThereAreForgotten) {
    const SensorSetup first = tiled(1);
    StreamHeader whole = stream_header_of(first, {});
    RecentSlots recent(large_layout(), 0, whole);
    const std::vector<std::uint8_t> payload(large_layout().payload_bytes());
    Emulator emulator(first);
    const std::vector<float> light(kShape.sites(), 0.2F);
    for (int slot = 0; slot < kSlots; ++slot) {
        if (slot == 5 || slot == 60 || slot == 85 || slot == 120) {
            const SensorSetup next = tiled(static_cast<std::uint64_t>(slot));
            emulator.switch_to(next);
            ScheduleSwitch made = switch_of(next);
            made.slot = slot;
            made.number = static_cast<std::uint16_t>(whole.switches.size() + 1);
            whole.switches.push_back(made);
            recent.add(made);
        }
        recent.add(payload, emulator.expose(light), 1);
    }
    const std::int64_t begin = recent.extent().first;
    EXPECT_EQ(begin, kSlots - 48);
    std::vector<SamplePacket> packets;
    const auto header =
        recent.visit(begin, kSlots, [&](const SamplePacket& packet) { packets.push_back(packet); });
    EXPECT_EQ(packets.size(), 48U);
    ASSERT_EQ(header->switches.size(), 3U);
    EXPECT_EQ(header->switches.front().slot, 60);
    EXPECT_EQ(header->schedule, whole.switches.front().schedule);
    const VideoWindow window{.first_slot = begin, .slots = 48, .shape = kShape};
    const Measurements known = collect_measurements(*header, packets, window);
    const Measurements expected = collect_measurements(whole, packets, window);
    EXPECT_EQ(known.state, expected.state);
    EXPECT_EQ(known.sum, expected.sum);
}

}  // namespace
}  // namespace stipple
