#include "readout/timing/readout_pipeline.h"

#include <gtest/gtest.h>

#include "tests/readout/timing/random_readout.h"
#include "tests/readout/timing/sensor_timing.h"

namespace stipple {
namespace {

using Kind = ReadoutCommand::Kind;

/// Expects that `command` is refused one clock before `cycle`, and issues it then.
void issue_first_at(ReadoutPipeline& pipeline, const ReadoutCommand& command, std::int64_t cycle) {
    EXPECT_EQ(pipeline.earliest_cycle(command), cycle);
    EXPECT_FALSE(pipeline.issue(command, cycle - 1));
    EXPECT_EQ(pipeline.earliest_cycle(command), cycle) << "a refused command changes nothing";
    EXPECT_TRUE(pipeline.issue(command, cycle));
    EXPECT_EQ(pipeline.earliest_cycle(command), ReadoutPipeline::kNever) << "not twice";
}

// LUX1310 with 20 clocks of settling: a conversion takes 23 clocks, 40 columns a channel take 42.
TEST(ReadoutPipelineTest, AnOverlappedRowIsTransferredWhileTheNextOneIsConverted) {
    const auto timing = sensor_timing("lux1310");
    ReadoutPipeline pipeline(timing);
    pipeline.begin_slot(1000, 82, 20);
    issue_first_at(pipeline, {Kind::kSelect, 5, 0}, 1093);
    issue_first_at(pipeline, {Kind::kConvert, 5, 1}, 1093);
    issue_first_at(pipeline, {Kind::kSelect, 6, 0}, 1116);
    issue_first_at(pipeline, {Kind::kConvert, 6, 1}, 1116);
    EXPECT_EQ(pipeline.earliest_cycle({Kind::kSelect, 7, 0}), ReadoutPipeline::kNever)
        << "both latches are full";
    issue_first_at(pipeline, {Kind::kTransfer, 5, 40}, 1116);
    issue_first_at(pipeline, {Kind::kSelect, 7, 0}, 1158);
    issue_first_at(pipeline, {Kind::kTransfer, 6, 40}, 1158);
    issue_first_at(pipeline, {Kind::kConvert, 7, 1}, 1158);
    issue_first_at(pipeline, {Kind::kTransfer, 7, 10}, 1200);
    EXPECT_EQ(pipeline.end_cycle(), 1223) << "the last row takes a whole row time";
}

// VITA: 70 clocks of row overhead time, 12 columns an output and 2 clocks.
TEST(ReadoutPipelineTest, ConversionAndTransferOfSequentialRowsTakeTurns) {
    const auto timing = sensor_timing("vita");
    ReadoutPipeline pipeline(timing);
    pipeline.begin_slot(0, 392, 0);
    issue_first_at(pipeline, {Kind::kSelect, 0, 0}, 0);
    issue_first_at(pipeline, {Kind::kConvert, 0, 1}, 70);
    EXPECT_EQ(pipeline.earliest_cycle({Kind::kSelect, 1, 0}), ReadoutPipeline::kNever);
    issue_first_at(pipeline, {Kind::kTransfer, 0, 12}, 70);
    issue_first_at(pipeline, {Kind::kSelect, 1, 0}, 84);
    issue_first_at(pipeline, {Kind::kConvert, 1, 1}, 154);
    issue_first_at(pipeline, {Kind::kTransfer, 1, 12}, 154);
    EXPECT_EQ(pipeline.end_cycle(), 168);
}

// IMX273: 319 clocks and 40 rows of 370 clocks; the first row is converted in the last of these.
TEST(ReadoutPipelineTest, OverheadRowsHideTheFirstConversion) {
    const auto timing = sensor_timing("imx273");
    ReadoutPipeline pipeline(timing);
    pipeline.begin_slot(0, 370, 0);
    issue_first_at(pipeline, {Kind::kSelect, 0, 0}, 319 + 39 * 370);
    issue_first_at(pipeline, {Kind::kConvert, 0, 1}, 319 + 39 * 370);
    issue_first_at(pipeline, {Kind::kTransfer, 0, 176}, 319 + 40 * 370);
}

TEST(ReadoutPipelineTest, BlankingFollowsConversionAndTransfer) {
    const auto timing =
        sensor_timing("lux1310", {"timing.blanking_clocks=5", "timing.skip_row_clocks=2"});
    ReadoutPipeline pipeline(timing);
    pipeline.begin_slot(0, 87, 20);
    issue_first_at(pipeline, {Kind::kSelect, 3, 0}, 93);
    issue_first_at(pipeline, {Kind::kConvert, 3, 1}, 99);
    issue_first_at(pipeline, {Kind::kTransfer, 3, 40}, 127);
    issue_first_at(pipeline, {Kind::kSelect, 4, 0}, 127);
    issue_first_at(pipeline, {Kind::kConvert, 4, 1}, 127);
    issue_first_at(pipeline, {Kind::kTransfer, 4, 40}, 174);
    EXPECT_EQ(pipeline.end_cycle(), 221);
}

TEST(ReadoutPipelineTest, CommandsOutOfOrderAreRefusedForever) {
    const auto timing = sensor_timing("lux1310");
    ReadoutPipeline pipeline(timing);
    pipeline.begin_slot(0, 82, 20);
    const auto refused = [&](const ReadoutCommand& command) {
        return pipeline.earliest_cycle(command) == ReadoutPipeline::kNever &&
               !pipeline.issue(command, 1'000'000);
    };
    EXPECT_TRUE(refused({Kind::kConvert, 0, 1})) << "nothing is selected";
    EXPECT_TRUE(refused({Kind::kTransfer, 0, 1}));
    EXPECT_TRUE(refused({Kind::kSelect, -1, 0})) << "there are no dark rows";
    ASSERT_TRUE(pipeline.issue({Kind::kSelect, 4, 0}, 93));
    EXPECT_TRUE(refused({Kind::kSelect, 5, 0})) << "row 4 is not converted";
    EXPECT_TRUE(refused({Kind::kTransfer, 4, 1}));
    EXPECT_TRUE(refused({Kind::kConvert, 5, 1}));
    ASSERT_TRUE(pipeline.issue({Kind::kConvert, 4, 1}, 93));
    EXPECT_TRUE(refused({Kind::kSelect, 4, 0})) << "rows rise";
    EXPECT_TRUE(refused({Kind::kSelect, 3, 0}));
}

struct Span {
    std::int64_t begin;
    std::int64_t end;
};

/// Whether span i of `later` begins when span j of `earlier` has ended, if there are both.
bool comes_after(const std::vector<Span>& later, std::size_t i, const std::vector<Span>& earlier,
                 std::size_t j) {
    return i >= later.size() || j >= earlier.size() || later[i].begin >= earlier[j].end;
}

// Commands that come late, in any order that is legal, never overlap.
TEST(ReadoutPipelineTest, LateCommandsKeepAdcsLinkAndLatchesApart) {
    for (std::uint32_t seed = 0; seed < 1000; ++seed) {
        Draw draw(seed);
        const ReadoutTiming timing = random_timing(draw);
        ReadoutPipeline pipeline(timing);
        pipeline.begin_slot(0, 20, draw(0, 5));
        std::vector<Span> spans[3];  // by kind of command
        int next[3] = {0, 0, 0};     // row, by kind of command
        for (int tries = 0; tries < 60; ++tries) {
            const int kind = draw(0, 2);
            const ReadoutCommand command{static_cast<Kind>(kind), next[kind], 1};
            const std::int64_t earliest = pipeline.earliest_cycle(command);
            if (earliest == ReadoutPipeline::kNever) continue;
            const std::int64_t cycle = earliest + draw(0, 9);
            const std::int64_t clocks = pipeline.clocks(command);
            ASSERT_TRUE(pipeline.issue(command, cycle));
            spans[kind].push_back({cycle, cycle + clocks});
            ++next[kind];
        }
        const std::size_t latches = timing.row_timing == RowTiming::kSequential ? 1 : 2;
        const auto& [select, convert, transfer] = spans;
        for (std::size_t i = 0; i < select.size(); ++i) {
            EXPECT_TRUE(comes_after(select, i, convert, i - 1)) << "seed " << seed;
            EXPECT_TRUE(comes_after(select, i, transfer, i - latches)) << "seed " << seed;
            EXPECT_TRUE(comes_after(convert, i, select, i)) << "seed " << seed;
            EXPECT_TRUE(comes_after(transfer, i, convert, i)) << "seed " << seed;
            EXPECT_TRUE(comes_after(transfer, i, transfer, i - 1)) << "seed " << seed;
        }
    }
}

}  // namespace
}  // namespace stipple
