#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/error.h"
#include "readout/timing/readout_timing.h"
#include "tests/readout/timing/sensor_timing.h"
#include "tests/support/source_tree.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

TEST(TimingConfigTest, ASensorWithoutTheSectionHasNoTiming) {
    Config config(project_path("config/sensors/paper.toml").string(), {});
    EXPECT_FALSE(read_timing(config, 8).has_value());
}

TEST(TimingConfigTest, KeysArriveWhereTheyBelong) {
    const ReadoutTiming timing = sensor_timing(
        "lux1310",
        {"timing.row_timing=full_width", "timing.addressing=group", "timing.group_cols=8",
         "timing.columns_per_adc=2", "timing.adc_skip=true", "timing.rot_clocks=7",
         "timing.blanking_clocks=6", "timing.skip_row_clocks=5", "timing.overhead_rows=4",
         "timing.link_lanes=3", "timing.link_bps=1000000", "timing.code_bit_pj=0.25"});
    EXPECT_EQ(timing.row_timing, RowTiming::kFullWidth);
    EXPECT_EQ(timing.addressing, (ColumnAddressing{ColumnAddressing::Kind::kGroup, 16, 8, 2}));
    EXPECT_EQ(timing.columns_per_adc, 2);
    EXPECT_EQ(timing.adcs(), 640);
    EXPECT_TRUE(timing.adc_skip);
    EXPECT_EQ(timing.rot_clocks, 7);
    EXPECT_EQ(timing.blanking_clocks, 6);
    EXPECT_EQ(timing.skip_row_clocks, 5);
    EXPECT_EQ(timing.overhead_rows, 4);
    EXPECT_EQ(timing.overhead_clocks, 93);
    EXPECT_EQ(timing.link_lanes, 3);
    EXPECT_EQ(timing.link_bps, 1000000);
    EXPECT_EQ(timing.code_bit_pj, 0.25);
    EXPECT_EQ(timing.bits_per_sample, 12);
    EXPECT_EQ(timing.settle_clocks.size(), 9U);
}

// Of each sensor: 30 us for 320 rows; 3 fF a row, charged to 1.2 V; 100 pJ for 10 bits.
TEST(TimingConfigTest, AssumedConstantsFollowTheSizeOfTheChip) {
    for (const char* name :
         {"cmv4000", "imx273", "imx296", "lux1310", "lux2100", "plc720", "sp5000", "vita"}) {
        const ReadoutTiming timing = sensor_timing(name);
        const double load_s =
            static_cast<double>(timing.code_load_clocks) / static_cast<double>(timing.clock_hz);
        EXPECT_NEAR(load_s, timing.rows * 30e-6 / 320, 1 / static_cast<double>(timing.clock_hz))
            << name;
        EXPECT_NEAR(timing.code_bit_pj, timing.rows * 3e-3 * 1.2 * 1.2, 0.05) << name;
        EXPECT_DOUBLE_EQ(conversion_energy_pj(timing),
                         100 * std::pow(2, timing.bits_per_sample - 10))
            << name;
        EXPECT_TRUE(timing.hypothetical.find("exposes all pixels alike") != std::string::npos);
        EXPECT_EQ(timing.hypothetical.find("whole rows") != std::string::npos,
                  timing.row_timing == RowTiming::kFullWidth);
    }
}

TEST(TimingConfigTest, ImpossibleTimingNamesTheConstraint) {
    struct Case {
        std::vector<std::string> overrides;
        std::vector<std::string> parts;
    };
    for (const Case& bad : {
             Case{{"timing.clock_hz=0"}, {"timing.clock_hz", "1.."}},
             Case{{"timing.channels=7"}, {"lux1310", "7 channels", "1280 columns"}},
             Case{{"timing.columns_per_adc=3"}, {"3 columns_per_adc", "1280"}},
             Case{{"timing.group_rows=2000"}, {"group", "2000"}},
             Case{{"timing.io_clocks=0", "timing.clocks_per_column=0"}, {"0 clocks"}},
             Case{{"timing.link_lanes=4"}, {"link_lanes", "link_bps"}},
             Case{{"timing.settle_clocks=[5, 5]"}, {"settle_clocks", "rise"}},
             Case{{"timing.row_table_cols=[1280]"}, {"row_table_cols", "row_table_clocks"}},
             Case{{"timing.row_table_cols=[640]", "timing.row_table_clocks=[9]"}, {"640", "1280"}},
             Case{{"timing.row_table_cols=[640, 1280]", "timing.row_table_clocks=[9, 8]"},
                  {"row_table_clocks", "falls"}},
             Case{{"timing.overhead_rows=65535", "timing.adc_clocks=100000000"},
                  {"exceed", "rows"}},
             Case{{"timing.row_timing=random"}, {"timing.row_timing", "overlapped"}},
             Case{{"timing.rows=70000"}, {"timing.rows", "65535"}},
             Case{{"timing.channel=8"}, {"timing.channel", "timing.channels"}},
         })
        expect_parts(
            message_of<InputError>([&] { return sensor_timing("lux1310", bad.overrides); }),
            bad.parts);
}

TEST(TimingConfigTest, ATimingWithoutAClockIsRefused) {
    TemporaryFolder folder;
    write_text(folder / "s.toml", "[timing]\nrows = 4\ncols = 4\n");
    Config config(folder / "s.toml", {});
    expect_parts(message_of<InputError>([&] { return read_timing(config, 8); }),
                 {"s.toml", "timing.clock_hz", "missing"});
}

// With lanes, the bits of a row count: 2048 x 10 bits on 8 lanes of 240 Mbit/s take 512 clocks of
// 48 MHz, twice the channels' 256.
TEST(TimingConfigTest, ASlowLinkHoldsTheTransferUp) {
    const auto timing = sensor_timing("cmv4000", {"timing.link_bps=240000000"});
    EXPECT_EQ(transfer_clocks(timing, 256), 514);
    const auto odd =
        sensor_timing("cmv4000", {"timing.link_bps=479999999", "timing.row_timing=overlapped"});
    EXPECT_EQ(transfer_clocks(odd, 256), 259) << "a clock that has begun counts";
}

}  // namespace
}  // namespace stipple
