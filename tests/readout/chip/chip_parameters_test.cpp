#include "readout/chip/chip_parameters.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "readout/program/sequencer_program.h"

namespace stipple {
namespace {

TEST(ChipParametersTest, ACutArrayKeepsTheShareOfTheSlotThatARowTakes) {
    SensorSetup setup = set_up_sensor({.sensor = "lux1310", .schedule = "tiled"}, {16, 32, 1});
    cut_array(setup);
    EXPECT_EQ(setup.timing->rows, 16);
    EXPECT_EQ(setup.timing->cols, 32);
    EXPECT_DOUBLE_EQ(setup.params.slot_us, 500.0 * 16 / 1024);
    EXPECT_FALSE(setup.origin);
    const ChipParameters chip = chip_parameters(setup, compile_schedule(setup.schedule.schedule));
    EXPECT_EQ(chip.word_bytes, 32);  // of 16 channels x 12 bits
    EXPECT_EQ(chip.dark_rows, std::max(1, setup.timing->dark_rows));
    // Two packets of all pixels fit.
    EXPECT_GE(chip.words * chip.word_bytes * 8, 2 * 16 * 32 * 12);
}

}  // namespace
}  // namespace stipple
