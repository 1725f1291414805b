#include "readout/chip/chip_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "core/error.h"
#include "readout/chip/chip_parameters.h"
#include "tests/readout/timing/sensor_timing.h"

namespace stipple {
namespace {

std::map<std::string, std::uint32_t> by_name(const std::vector<RegisterValue>& values) {
    std::map<std::string, std::uint32_t> result;
    for (const auto& [address, value] : values) result[register_name(address)] = value;
    EXPECT_EQ(result.size(), values.size()) << "each register once";
    return result;
}

ChipCapture capture_of(const char* sensor) {
    return {.timing = sensor_timing(sensor),
            .window = {16, 32, 1},
            .budget = {1000, OverrunPolicy::kDrop},
            .period_slots = 15};
}

TEST(ChipSettingsTest, UnusedPlacesOfAListHaveItsLastValue) {
    const ChipCapture capture = capture_of("lux1310");
    auto values = by_name(chip_settings(capture, 1));
    const auto& settles = capture.timing.settle_clocks;
    EXPECT_EQ(values.at("SETTLE_CLOCKS[0]"), settles.front());
    EXPECT_EQ(values.at("SETTLE_CLOCKS[15]"), settles.back());
    EXPECT_EQ(values.at("BANK_PERIOD[1]"), 15);
    EXPECT_EQ(values.count("BANK_PERIOD[0]"), 0);
    EXPECT_EQ(values.at("DROPS"), 1);
    EXPECT_EQ(values.at("HAS_TABLE"), 0);
}

TEST(ChipSettingsTest, ALinkIsAProductOfMoreThan32Bits) {
    const ChipCapture capture = capture_of("cmv4000");
    auto values = by_name(chip_settings(capture, 0));
    const ReadoutTiming& timing = capture.timing;
    const std::uint64_t bits =
        std::uint64_t{values.at("LINK_BITS_HIGH")} << 32U | values.at("LINK_BITS_LOW");
    EXPECT_EQ(bits, static_cast<std::uint64_t>(timing.clock_hz) * 8 * 10);
}

TEST(ChipSettingsTest, AMarginBelow0IsATwosComplement) {
    ChipCapture capture = capture_of("lux1310");
    capture.timing.settle_margin = -3;
    EXPECT_EQ(by_name(chip_settings(capture, 0)).at("SETTLE_MARGIN"), 0xFFFF'FFFD);
}

TEST(ChipSettingsTest, NamesTheRegisterThatCannotHoldAValue) {
    const auto expect_refused = [](const ChipCapture& capture, const std::string& part) {
        try {
            static_cast<void>(chip_settings(capture, 0));
            ADD_FAILURE() << part;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr(part));
        }
    };
    ChipCapture capture = capture_of("lux1310");
    capture.budget.clocks = std::int64_t{1} << 32;
    expect_refused(capture, "SLOT_CLOCKS has 32 bits");
    capture = capture_of("lux1310");
    capture.period_slots = 65536;
    expect_refused(capture, "BANK_PERIOD[0] has 16 bits");
    capture = capture_of("lux1310");
    capture.timing.settle_clocks.assign(17, 1);
    expect_refused(capture, "17 values do not fit the 16 registers SETTLE_CLOCKS");
}

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
