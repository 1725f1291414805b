#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "readout/chip/register_chip.h"
#include "readout/chip/register_map.h"
#include "readout/chip_registers.h"
#include "tests/readout/chip/small_chip.h"

namespace stipple {
namespace {

class ChipLimitsTest : public SmallChipTest {};

TEST_F(ChipLimitsTest, AfterAResetRegistersHaveTheValuesOfTheTable) {
    const SensorSetup setup = small_sensor("tiled");
    RegisterChip chip(setup, geometry_of(setup), {});
    EXPECT_EQ(get(chip, STIPPLE_ID), 0x53504C31U);
    EXPECT_EQ(get(chip, STIPPLE_ARRAY_COLS), 12U);
    EXPECT_EQ(get(chip, STIPPLE_CHANNELS), 2U);
    EXPECT_EQ(get(chip, STIPPLE_DEPTH), 16U);
    EXPECT_EQ(chip.clocks(), 8);
    for (const ChipRegister& it : chip_registers())
        if (it.access == ChipRegister::Access::kBoth) {
            EXPECT_EQ(get(chip, it.address + 4 * (it.count - 1)), it.reset) << it.name;
        }
    EXPECT_EQ(get(chip, STIPPLE_STATUS), 0U);
    EXPECT_EQ(get(chip, STIPPLE_ERROR), 0U);
}

TEST_F(ChipLimitsTest, AnAccessThatIsAnErrorChangesNothingElse) {
    RegisterChip chip = preset_chip(small_sensor("tiled"));
    const std::uint32_t rows = get(chip, STIPPLE_ROWS);
    const auto refused = [&](std::uint32_t address, std::uint32_t value, const char* why) {
        EXPECT_FALSE(chip.write(address, value));
        EXPECT_NE(chip.take_problem().find(why), std::string::npos) << why;
        EXPECT_EQ(get(chip, STIPPLE_ERROR), std::uint32_t{STIPPLE_ERROR_ACCESS});
        set(chip, STIPPLE_ERROR, STIPPLE_ERROR_ACCESS);
        EXPECT_EQ(get(chip, STIPPLE_ERROR), 0U);
    };
    refused(STIPPLE_ROWS, 1U << 16U, "ROWS has 16 bits, at most 65535");
    refused(STIPPLE_ID, 1, "ID is read-only");
    refused(0x3C, 1, "0x03C is not a register");
    refused(STIPPLE_CONTROL + 1, 1, "0x041 is not a register");
    set(chip, STIPPLE_MEMORY_ADDRESS, 0x80000000U + 16U * get(chip, STIPPLE_TILE_ROWS));
    refused(STIPPLE_MEMORY_DATA, 1, "a bank has");
    EXPECT_FALSE(chip.read(0x1000));
    EXPECT_EQ(get(chip, STIPPLE_ERROR), std::uint32_t{STIPPLE_ERROR_ACCESS});
    EXPECT_EQ(get(chip, STIPPLE_ROWS), rows);
    EXPECT_EQ(get(chip, STIPPLE_CONTROL), 0U);
}

TEST_F(ChipLimitsTest, RunningSettingsAndTheActiveBankAreLocked) {
    RegisterChip chip = preset_chip(small_sensor("tiled"));
    set(chip, STIPPLE_MEMORY_ADDRESS, 0);
    set(chip, STIPPLE_CONTROL, kStart);
    EXPECT_FALSE(chip.write(STIPPLE_ROWS, 4));
    EXPECT_FALSE(chip.write(STIPPLE_BANK_PERIOD, 4));
    EXPECT_FALSE(chip.write(STIPPLE_MEMORY_DATA, 4));
    set(chip, STIPPLE_BANK_PERIOD + 4, 4);
    set(chip, STIPPLE_MEMORY_ADDRESS, 0x80000000U);
    set(chip, STIPPLE_MEMORY_DATA, 4);
    EXPECT_EQ(get(chip, STIPPLE_ERROR), std::uint32_t{STIPPLE_ERROR_ACCESS});
    chip.finish();
    set(chip, STIPPLE_ROWS, 4);
}

TEST_F(ChipLimitsTest, ACommandOutsideItsLimitsIsRefused) {
    RegisterChip chip = preset_chip(small_sensor("tiled"));
    const auto refused = [&](std::uint32_t address, std::uint32_t value, const char* why) {
        const std::uint32_t before = get(chip, address);
        set(chip, address, value);
        set(chip, STIPPLE_CONTROL, kStart);
        EXPECT_NE(chip.take_problem().find(why), std::string::npos) << why;
        EXPECT_EQ(get(chip, STIPPLE_ERROR), std::uint32_t{STIPPLE_ERROR_SETUP}) << why;
        EXPECT_EQ(get(chip, STIPPLE_STATUS), 0U);
        set(chip, STIPPLE_ERROR, STIPPLE_ERROR_SETUP);
        set(chip, address, before);
    };
    refused(STIPPLE_ROWS, 9, "ROWS: 9 is not 1 to 8");
    refused(STIPPLE_COLS, 0, "COLS: 0 is not 1 to 12");
    refused(STIPPLE_SLOT_CLOCKS, 0, "SLOT_CLOCKS: is 0");
    refused(STIPPLE_ROW_TIMING, 3, "ROW_TIMING: 3 is not 0 to 2");
    refused(STIPPLE_CLOCKS_PER_COLUMN, 0, "CLOCKS_PER_COLUMN: 0 is not 1");
    refused(STIPPLE_DARK_ROWS, 3, "DARK_ROWS: 3 is not 0 to 2");
    refused(STIPPLE_BANK_PERIOD, 17, "BANK_PERIOD[0]: 17 is not 1 to 16");
    refused(STIPPLE_BANK_OFFSET, 60, "is not less than the period");
    refused(STIPPLE_LINK_BITS_LOW, 7, "LINK_RATE_LOW: is 0");
    // The memory of bank 1 is empty: its pixels are never read.
    set(chip, STIPPLE_BANK_PERIOD + 4, 4);
    set(chip, STIPPLE_CONTROL, kStart | STIPPLE_CONTROL_SWAP);
    EXPECT_NE(chip.take_problem().find("bank 1"), std::string::npos);
    EXPECT_EQ(get(chip, STIPPLE_STATUS), std::uint32_t{STIPPLE_STATUS_BANK});
}

TEST_F(ChipLimitsTest, AProgramThatDoesNotFitIsRefused) {
    const SensorSetup setup = small_sensor("tiled");
    const auto refusal = [&](auto change) {
        ChipGeometry geometry = geometry_of(setup);
        change(geometry);
        return message_of<InputError>([&] {
            RegisterChip chip(setup, geometry, {});
            chip.preset();
            return 0;
        });
    };
    EXPECT_NE(refusal([](ChipGeometry& it) { it.tile_cols += 1; }).find("does not divide"),
              std::string::npos);
    EXPECT_NE(refusal([](ChipGeometry& it) { it.depth = 2; }).find("are more than the 2 of a bank"),
              std::string::npos);
    EXPECT_NE(refusal([](ChipGeometry& it) { it.pixel_bits = 4; }).find("PIXEL_BITS = 4"),
              std::string::npos);
    EXPECT_NE(refusal([](ChipGeometry& it) { it.depth = 65536; }).find("DEPTH"), std::string::npos);
}

TEST_F(ChipLimitsTest, CapturesHaveNumberedFiles) {
    RegisterChip chip = preset_chip(small_sensor("tiled"));
    set(chip, STIPPLE_CONTROL, kStart);
    set(chip, STIPPLE_CONTROL, STIPPLE_CONTROL_STOP);  // before slot 0
    chip.wait(10000);
    EXPECT_EQ(get(chip, STIPPLE_STATUS), 0U);
    EXPECT_TRUE(folder_.names().empty());
    set(chip, STIPPLE_SLOTS, 2);
    for (int i = 0; i < 2; ++i) {
        set(chip, STIPPLE_CONTROL, kStart);
        chip.wait(10000);
    }
    EXPECT_EQ(folder_.names(), (std::vector<std::string>{"a-2.stipple", "a.stipple"}));
    EXPECT_EQ(chip.outputs().size(), 2U);
}

}  // namespace
}  // namespace stipple
