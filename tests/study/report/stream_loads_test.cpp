#include "study/report/stream_samples.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <nlohmann/json.hpp>

#include "readout/sensor_file.h"
#include "readout/timing/readout_cost.h"
#include "stream/stream_reader.h"
#include "tests/study/report/recorded_clip.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 16, .cols = 32, .planes = 1};
constexpr int kSlots = 20;

nlohmann::ordered_json loads_of(const std::filesystem::path& file) {
    StreamReader reader(file);
    StreamLoads loads(reader.header());
    for (SamplePacket packet; reader.next(packet);) loads.add(packet);
    return loads.json();
}

TEST(StreamLoadsTest, AnUndamagedStreamHasTheSamplesThatAreDue) {
    const TemporaryFolder folder;
    record_clip(folder / "a.stipple", {}, ramp(kSlots, kShape));
    const auto loads = loads_of(folder / "a.stipple");
    const ExposureSchedule schedule = random_schedule(16, 32, kPaperExposureSlots, 1);
    ASSERT_EQ(loads["samples"].size(), kSlots);
    EXPECT_EQ(loads["samples"], loads["due"]);
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
        const std::size_t due = count_due(schedule, static_cast<std::int64_t>(slot), 0, 16, 32);
        EXPECT_EQ(loads["due"][slot], due);
        EXPECT_EQ(loads["payload_bits"][slot], 8 * due);
    }
    EXPECT_EQ(loads["full_bits"], 8 * 16 * 32);
    EXPECT_TRUE(loads["clocks"].is_null());  // the paper's sensor has none
}

TEST(StreamLoadsTest, ClocksAreThoseOfTheReadoutCost) {
    const TemporaryFolder folder;
    const SensorChoice choice{.sensor = "lux1310"};
    record_clip(folder / "a.stipple", choice, ramp(kSlots, kShape));
    const auto loads = loads_of(folder / "a.stipple");
    const SensorSetup setup = set_up_sensor(choice, kShape);
    ReadoutCost cost(*setup.timing, setup.schedule.schedule, kShape,
                     {slot_clocks(*setup.timing, setup.params.slot_us), OverrunPolicy::kStretch});
    const auto& clocks = loads["clocks"];
    EXPECT_EQ(clocks["clock_hz"], setup.timing->clock_hz);
    EXPECT_EQ(clocks["slot_clocks"], cost.budget().clocks);
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
        const SlotCost& expected = cost.add_next();
        EXPECT_EQ(clocks["readout"][slot], expected.counts.readout_clocks);
        EXPECT_EQ(clocks["link"][slot], expected.counts.link_clocks);
        EXPECT_EQ(clocks["link_bits"][slot], expected.counts.bits);
        EXPECT_EQ(clocks["limit"][slot], name_of(expected.limit));
    }
}

}  // namespace
}  // namespace stipple
