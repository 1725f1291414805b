#include "readout/timing/waveform.h"

#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "readout/schedules/tiled_schedule.h"
#include "tests/readout/timing/random_readout.h"
#include "tests/readout/timing/sensor_timing.h"

namespace stipple {
namespace {

/// Values by name of signal.
using Values = std::map<std::string, std::int64_t>;

/// Reads a VCD file of wires of at most 64 bits; calls `visit(time, values)` after each time's
/// changes.
template <typename Visit>
void parse(const std::string& text, Visit visit) {
    std::istringstream stream(text);
    std::map<std::string, std::string> names;
    Values values;
    std::int64_t time = -1;
    for (std::string line; std::getline(stream, line);) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "$var") {
            std::string wire;
            std::string bits;
            std::string code;
            words >> wire >> bits >> code >> names[code];
        } else if (word[0] == '#') {
            if (time >= 0) visit(time, values);
            ASSERT_GE(std::stoll(word.substr(1)), time) << "time runs forward";
            time = std::stoll(word.substr(1));
        } else if (word[0] == 'b') {
            std::string code;
            words >> code;
            values[names.at(code)] = static_cast<std::int64_t>(std::stoull(word.substr(1), {}, 2));
        } else if (word[0] == '0' || word[0] == '1') {
            values[names.at(word.substr(1))] = word[0] - '0';
        }
    }
    visit(time, values);
}

std::string waveform_of(ReadoutCost& cost, std::int64_t slots) {
    Waveform waveform(cost.timing(), "a chip");
    std::string text = waveform.head();
    for (std::int64_t slot = 0; slot < slots; ++slot) text += waveform.add_slot(cost);
    return text + waveform.tail(cost.clocks());
}

// The file is sampled between its changes: busy clocks add up to those of the cost.
TEST(WaveformTest, BusyTimesAreThoseOfTheAccount) {
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
        Draw draw(seed);
        ReadoutTiming timing = random_timing(draw);
        timing.skip_row_clocks = 0;
        const FrameShape shape{timing.rows, timing.cols, 1};
        const auto schedule = random_schedule(3, 4, std::vector{1, 2, 4}, seed);
        const SlotBudget budget{draw(0, 1) * 1000, OverrunPolicy::kStretch};
        ReadoutCost cost(timing, schedule, shape, budget);
        constexpr std::int64_t kSlots = 9;
        Values total;
        Values before;
        parse(waveform_of(cost, kSlots), [&](std::int64_t time, const Values& values) {
            // 1 MHz: a clock is 10^6 ps.
            const std::int64_t clocks = values.at("cycle") - before["cycle"];
            for (const auto& [name, value] : before)
                if (name != "cycle") total[name] += value * clocks;
            if (time % 1'000'000 != 0) ADD_FAILURE() << time;
            before = values;
        });
        const ReadoutCounts& counts = cost.totals();
        EXPECT_EQ(total["link_valid"], counts.link_clocks) << "seed " << seed;
        EXPECT_EQ(total["row_select"], counts.convert_clocks) << "seed " << seed;
        EXPECT_EQ(total["adc_busy"], counts.convert_clocks - counts.rows * timing.rot_clocks)
            << "seed " << seed;
        EXPECT_EQ(total["code_load"], kSlots * timing.code_load_clocks) << "seed " << seed;
        EXPECT_EQ(total["slot_start"], kSlots) << "seed " << seed;
        ASSERT_FALSE(testing::Test::HasFailure());
    }
}

TEST(WaveformTest, TimesAreTrueToHalfAPicosecond) {
    const auto timing = sensor_timing("lux1310");
    const auto every_slot = full_schedule(1, 1);
    ReadoutCost cost(timing, every_slot, {4, 64, 1}, {});
    int changes = 0;
    parse(waveform_of(cost, 2), [&](std::int64_t time, const Values& values) {
        const double exact = static_cast<double>(values.at("cycle")) * 1e12 / 90e6;
        EXPECT_NEAR(static_cast<double>(time), exact, 0.5001);
        ++changes;
    });
    EXPECT_GT(changes, 20);
}

TEST(WaveformTest, EachRowShowsItsNumberAndItsChannels) {
    const auto timing = sensor_timing("lux1310");
    const auto every_slot = full_schedule(1, 1);
    ReadoutCost cost(timing, every_slot, {3, 24, 1}, {});
    std::vector<std::int64_t> rows;
    parse(waveform_of(cost, 1), [&](std::int64_t, const Values& values) {
        if (values.at("link_valid") == 0) return;
        if (rows.empty() || rows.back() != values.at("link_row"))
            rows.push_back(values.at("link_row"));
        EXPECT_EQ(values.at("columns"), 24);
        // 24 columns on 16 channels: the first 8 read two.
        const std::int64_t busy = values.at("channel_busy");
        EXPECT_TRUE(busy == 0xFFFF || busy == 0xFF) << busy;
    });
    EXPECT_EQ(rows, (std::vector<std::int64_t>{0, 1, 2}));
}

}  // namespace
}  // namespace stipple
