#include "readout/chip/chip_settings.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "readout/chip/register_map.h"
#include "readout/chip_registers.h"
#include "tests/readout/timing/random_readout.h"

namespace stipple {
namespace {

TEST(ChipSettingsTest, RegistersHoldATiming) {
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        Draw draw(seed);
        ReadoutTiming timing = random_timing(draw);
        timing.exposes_while_reading = draw(0, 1) == 1;
        timing.bits_per_sample = 10;
        const FrameShape shape{draw(1, timing.rows), draw(1, timing.cols), 1};
        const SlotBudget budget{draw(0, 2) * draw(1, 60), OverrunPolicy::kStretch};
        RegisterValues values = register_values(timing, shape, budget);
        const ChipGeometry geometry{.rows = timing.rows,
                                    .cols = timing.cols,
                                    .addressing = timing.addressing,
                                    .columns_per_adc = timing.columns_per_adc};
        const CaptureSettings given = capture_settings(values, geometry);
        const ExposureSchedule schedule = random_frames(draw);
        ReadoutCost expected(timing, schedule, shape, budget);
        ReadoutCost cost(given.timing, schedule, given.window, given.slot);
        for (int slot = 0; slot < 20; ++slot) {
            const SlotCost a = expected.add_next(), b = cost.add_next();
            EXPECT_EQ(a.begin, b.begin);
            EXPECT_EQ(a.scan_begin, b.scan_begin);
            EXPECT_EQ(a.clocks, b.clocks);
            EXPECT_EQ(a.counts.readout_clocks, b.counts.readout_clocks);
            EXPECT_EQ(a.overrun, given.budget_clocks > 0 && b.clocks > given.budget_clocks);
        }
        ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed;
    }
}

TEST(RegisterMapTest, RegistersHaveNames) {
    EXPECT_EQ(register_address("STATUS"), std::uint32_t{STIPPLE_STATUS});
    EXPECT_EQ(register_address("0x44"), std::uint32_t{STIPPLE_STATUS});
    EXPECT_EQ(register_address("68"), std::uint32_t{STIPPLE_STATUS});
    EXPECT_EQ(register_address("BANK_PERIOD"), std::uint32_t{STIPPLE_BANK_PERIOD});
    EXPECT_EQ(register_address("BANK_PERIOD[1]"), STIPPLE_BANK_PERIOD + 4U);
    EXPECT_EQ(register_name(STIPPLE_BANK_PERIOD + 4), "BANK_PERIOD[1]");
    EXPECT_EQ(register_name(0x3C), "0x03C");
    for (const char* text :
         {"STAUS", "BANK_PERIOD[2]", "BANK_PERIOD[", "STATUS[1]", "", "0x", "-1", "4294967296"})
        EXPECT_THROW(static_cast<void>(register_address(text)), InputError) << text;
    EXPECT_EQ(register_value("0xFFFFFFFF"), 0xFFFFFFFFU);
    EXPECT_THROW(static_cast<void>(register_value("1.5")), InputError);
}

}  // namespace
}  // namespace stipple
