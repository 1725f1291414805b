#include "readout/timing/row_loads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "core/error.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/readout/timing/random_readout.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

/// The definition, pixel by pixel: all pairs of a pixel that is due and one that goes with it.
std::set<int> transferred(const ReadoutTiming& timing, const ExposureSchedule& schedule,
                          FrameShape shape, std::int64_t slot, int row) {
    const bool grouped = timing.addressing.kind == ColumnAddressing::Kind::kGroup;
    const int rows = grouped ? timing.addressing.group_rows : 1;
    const int cols = grouped ? timing.addressing.group_cols : 1;
    std::set<int> columns;
    for (int other = 0; other < shape.rows; ++other) {
        if (other / rows != row / rows) continue;
        for_each_readout(schedule, slot, other, shape.cols, [&](int due, int) {
            for (int col = 0; col < shape.cols; ++col)
                if (col / cols == due / cols) columns.insert(col);
        });
    }
    return columns;
}

int most_alike(const std::set<int>& columns, int modulus) {
    std::vector<int> counts(static_cast<std::size_t>(modulus), 0);
    for (const int col : columns) ++counts[static_cast<std::size_t>(col % modulus)];
    return std::ranges::max(counts);
}

TEST(RowLoadsTest, AreThoseOfTheDefinition) {
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        Draw draw(seed);
        const ReadoutTiming timing = random_timing(draw);
        const FrameShape shape{draw(1, timing.rows), draw(1, timing.cols), 1};
        const auto schedule = random_schedule(draw(1, 5), draw(1, 5), std::vector{2, 3, 4}, seed);
        RowLoads row_loads(timing, schedule, shape);
        for (int slot = 0; slot < 12; ++slot) {
            std::vector<RowLoad> expected;
            for (int row = 0; row < shape.rows; ++row) {
                const auto columns = transferred(timing, schedule, shape, slot, row);
                if (columns.empty()) continue;
                int again = 1;
                while (transferred(timing, schedule, shape, slot + again, row).empty()) ++again;
                expected.push_back(
                    {.row = row,
                     .due = static_cast<int>(count_due(schedule, slot, row, 1, shape.cols)),
                     .columns = static_cast<int>(columns.size()),
                     .channel_columns = most_alike(columns, timing.addressing.channels),
                     .conversions = timing.adc_skip ? most_alike(columns, timing.adcs())
                                                    : timing.columns_per_adc});
                EXPECT_EQ(row_loads.due_again_slots(slot, row), again);
                const auto by_channel = row_loads.channel_columns(slot, row);
                EXPECT_EQ(std::accumulate(by_channel.begin(), by_channel.end(), 0),
                          expected.back().columns);
                EXPECT_EQ(std::ranges::max(by_channel), expected.back().channel_columns);
            }
            std::vector<RowLoad> loads;
            row_loads.list(slot, loads);
            std::erase_if(loads, [](const RowLoad& load) { return load.row < 0; });
            ASSERT_EQ(loads, expected) << "seed " << seed << ", slot " << slot;
        }
    }
}

TEST(RowLoadsTest, DarkRowsComeFirstAndInFullIfAnyRowIsRead) {
    Draw draw(1);
    ReadoutTiming timing = random_timing(draw);
    timing.dark_rows = 2;
    const ExposureSchedule schedule = full_schedule(1, 2);
    RowLoads row_loads(timing, schedule, {timing.rows, timing.cols, 1});
    std::vector<RowLoad> loads;
    row_loads.list(0, loads);
    ASSERT_EQ(loads.size(), static_cast<std::size_t>(timing.rows) + 2);
    EXPECT_EQ(loads[0].row, -2);
    EXPECT_EQ(loads[1].row, -1);
    EXPECT_EQ(loads[0].due, 0);
    EXPECT_EQ(loads[0].columns, timing.cols);
    row_loads.list(1, loads);
    EXPECT_TRUE(loads.empty());
}

TEST(RowLoadsTest, AWindowBeyondTheArrayIsRefused) {
    Draw draw(1);
    const ReadoutTiming timing = random_timing(draw);
    expect_parts(message_of<InputError>([&] {
                     check_window(timing, {timing.rows, 4711, 1});
                     return 0;
                 }),
                 {"4711", "array", "timing.cols"});
    EXPECT_THROW(check_window(timing, {timing.rows + 1, 1, 1}), InputError);
    EXPECT_THROW(check_window(timing, {0, 1, 1}), InputError);
}

}  // namespace
}  // namespace stipple
