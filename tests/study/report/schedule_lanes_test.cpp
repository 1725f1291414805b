#include "study/report/schedule_text.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <utility>

namespace stipple {
namespace {

using nlohmann::ordered_json;

TEST(ScheduleLanesTest, RunsAreTheSetBits) {
    EXPECT_EQ(open_runs_json(0b1), ordered_json::parse("[[0,1]]"));
    EXPECT_EQ(open_runs_json(0b1110011), ordered_json::parse("[[0,2],[4,3]]"));
    EXPECT_EQ(open_runs_json(~std::uint64_t{0}), ordered_json::parse("[[0,64]]"));
    EXPECT_EQ(open_runs_json(std::uint64_t{1} << 63U | 1U), ordered_json::parse("[[0,1],[63,1]]"));
}

TEST(ScheduleLanesTest, ALaneHoldsWhatIsReadOfItsPixel) {
    constexpr FrameShape kArray{.rows = 8, .cols = 8, .planes = 1};
    constexpr int kSlots = 40;
    const ExposureSchedule schedule = random_schedule(8, 8, kPaperExposureSlots, 1);
    const ordered_json lanes = lanes_json(schedule, kArray, 5, kSlots);
    ASSERT_EQ(lanes.size(), 5U);
    for (const ordered_json& lane : lanes) {
        std::map<int, int> spans;  // by slot of the readout
        for (const ordered_json& exposure : lane["exposures"]) {
            const int last = exposure[0].get<int>() + exposure[2].get<int>() - 1;
            if (last < kSlots) spans[last] = exposure[2];
        }
        std::map<int, int> due;
        for (int slot = 0; slot < kSlots; ++slot)
            for_each_readout(schedule, slot, lane["row"], 8, [&](int col, int span) {
                if (col == lane["col"]) due[slot] = span;
            });
        EXPECT_EQ(spans, due) << lane;
    }
}

}  // namespace
}  // namespace stipple
