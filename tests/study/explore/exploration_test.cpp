#include "study/explore/exploration.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "study/explore/results.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

/// psnr_db of a point with a seed and as many slots.
using Psnr = std::function<double(std::uint64_t point, std::uint64_t seed, int slots)>;

ExploreOptions options_of(int seeds, double clips = 0) {
    ExploreOptions options;
    options.seeds = seeds;
    if (clips > 0) {
        options.budget = Budget{clips};
        options.rank = "psnr_db";
    }
    return options;
}

/// Explores spaces of 24 slots, whose rungs are 12 and 24, with figures that the tests make up.
class ExplorationTest : public testing::Test {
  protected:
    void write_space(const std::string& axes) {
        write_text(folder_ / "space.toml", "[axes]\nsensor = 'paper'\nmethod = 'naive'\n" + axes +
                                               "[clip]\nframes = 24\nrows = 8\ncols = 8\n");
    }

    Exploration begun(const ExploreOptions& options) {
        return {folder_ / "space.toml", folder_ / "results", options, [] { return true; }};
    }

    Exploration explored(const ExploreOptions& options, const Psnr& psnr) {
        Exploration exploration = begun(options);
        const auto seeds = static_cast<std::uint64_t>(options.seeds);
        while (exploration.next_rung())
            for (const std::uint64_t number : exploration.due())
                if (exploration.begin(number) != nullptr)
                    put(exploration, number,
                        psnr(number / seeds, number % seeds, exploration.slots()));
        exploration.rank_points();
        return exploration;
    }

    static TrialOutcome empty_outcome() {
        return {.figures = {}, .picture = {.rows = 1, .cols = 1, .channels = 1, .bytes = {7}}};
    }

    /// Points whose figures are all 1 in the first one, 2 in the second; a little more for each
    /// seed.
    Exploration explored_by(const FigureColumn& rank, ExploreOptions options) {
        options.rank = rank.name;
        Exploration exploration = begun(options);
        const auto seeds = static_cast<std::uint64_t>(options.seeds);
        while (exploration.next_rung())
            for (const std::uint64_t number : exploration.due()) {
                if (exploration.begin(number) == nullptr) continue;
                TrialOutcome outcome = empty_outcome();
                for (const FigureColumn& column : kFigureColumns)
                    outcome.figures.*column.value = 1 + static_cast<double>(number / seeds) +
                                                    static_cast<double>(number % seeds) / 8;
                exploration.put(number, outcome);
            }
        exploration.rank_points();
        return exploration;
    }

    static void put(Exploration& exploration, std::uint64_t number, double psnr_db) {
        TrialOutcome outcome = empty_outcome();
        outcome.figures.slots_per_second = 200;
        outcome.figures.psnr_db = psnr_db;
        outcome.figures.decode_seconds = 1;
        exploration.put(number, outcome);
    }

    static TableValue value(const Exploration& exploration, std::uint64_t number,
                            const std::string& column) {
        for (const TableCell& cell : table_row(exploration, number))
            if (cell.column == column) return cell.value;
        return "no such column";
    }

    const TemporaryFolder folder_;
};

/// Trials that are run again when the same exploration is begun a second time.
int run_again(Exploration& exploration) {
    int again = 0;
    while (exploration.next_rung())
        for (const std::uint64_t number : exploration.due())
            if (exploration.begin(number) != nullptr) ++again;
    return again;
}

TEST_F(ExplorationTest, FiguresOfAnOwnDecoderAreKnownByItsVersion) {
    write_space("");
    for (const char* version : {"", "1"}) {
        ExploreOptions options = options_of(1);
        options.decoders = {{"own", [](const auto&, const auto&) { return FluxVideo(); }, version}};
        options.methods = {"own"};
        static_cast<void>(explored(options, [](auto, auto, auto) { return 30; }));
        Exploration second = begun(options);
        EXPECT_EQ(run_again(second), version[0] == '\0' ? 1 : 0);
        options.decoders[0].version = "2";
        Exploration other = begun(options);
        EXPECT_EQ(run_again(other), 1);
    }
}

TEST_F(ExplorationTest, DecodersOfOneNameOrThatOfAMethodAreRefused) {
    write_space("");
    ExploreOptions options = options_of(1);
    const OwnDecoder own{"own", [](const auto&, const auto&) { return FluxVideo(); }};
    options.decoders = {own, own};
    EXPECT_THROW(begun(options), InputError);
    options.decoders = {{"best", own.decode}};
    EXPECT_THROW(begun(options), InputError);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "results"));
}

const std::string kNoise = "[set]\n'sensor.read_noise_e' = [5, 20]\n";

/// More noise is worse at equal length, but less worse than a longer clip.
double noisy_psnr(std::uint64_t point, std::uint64_t /*seed*/, int slots) {
    if (slots == 12) return point == 0 ? 24.5 : 24.08;
    return point == 0 ? 23.64 : 23.61;
}

TEST_F(ExplorationTest, ADroppedPointComesAfterThoseOfALongerClip) {
    write_space(kNoise);
    const Exploration exploration = explored(options_of(1, 100), noisy_psnr);
    EXPECT_EQ(exploration.last_rung(), 2);
    EXPECT_EQ(exploration.points()[0].slots, 24);
    EXPECT_EQ(exploration.points()[1].slots, 12);
    EXPECT_EQ(value(exploration, 1, "psnr_db"), TableValue(24.08));
    EXPECT_EQ(exploration.best_first(), (std::vector<std::uint64_t>{0, 1}));
}

TEST_F(ExplorationTest, FiguresOfTheWholeClipAreKeptByARunWithABudget) {
    write_space(kNoise);
    const std::string table = csv_table(explored(options_of(1), noisy_psnr));
    EXPECT_NE(table.find("23.61"), std::string::npos);
    for (const double budget : {100.0, 0.5}) {
        const Exploration exploration = explored(options_of(1, budget), noisy_psnr);
        EXPECT_EQ(value(exploration, 1, "psnr_db"), TableValue(23.61));
        EXPECT_EQ(value(exploration, 1, "slots"), TableValue(24));
        EXPECT_EQ(value(exploration, 1, "problem"), TableValue(""));
        EXPECT_EQ(exploration.best_first(), (std::vector<std::uint64_t>{0, 1}));
    }
}

TEST_F(ExplorationTest, TheChoiceOfARungIsByItsOwnFigures) {
    // Of the whole clip the second one is better, and known; on the shorter clip it is worse.
    write_space(kNoise);
    const Psnr crossing = [](std::uint64_t point, std::uint64_t, int slots) {
        return (point == 0) == (slots == 12) ? 30.0 : 20.0;
    };
    static_cast<void>(explored(options_of(1), crossing));
    Exploration exploration = begun(options_of(1, 100));
    exploration.next_rung();
    for (const std::uint64_t number : exploration.due())
        if (exploration.begin(number) != nullptr)
            put(exploration, number, crossing(number, 0, exploration.slots()));
    exploration.next_rung();
    EXPECT_EQ(exploration.due(), std::vector<std::uint64_t>{0});
}

TEST_F(ExplorationTest, APointHasTheMeansOfItsSeeds) {
    write_space("seed = 7\n" + kNoise);
    const Psnr psnr = [](std::uint64_t point, std::uint64_t seed, int) {
        return 30 - 5.0 * static_cast<double>(point) + static_cast<double>(seed);
    };
    const Exploration exploration = explored(options_of(3), psnr);
    EXPECT_EQ(exploration.counts().run, 6);
    EXPECT_EQ(exploration.values_of(5)[exploration.space().axis("seed")], "9");
    EXPECT_EQ(value(exploration, 0, "seed"), TableValue("7"));
    EXPECT_EQ(value(exploration, 0, "psnr_db"), TableValue(31.0));
    const MeanInterval interval = mean_interval(std::vector{30.0, 31.0, 32.0});
    EXPECT_EQ(value(exploration, 0, "psnr_db_low"), TableValue(interval.low));
    EXPECT_EQ(value(exploration, 0, "psnr_db_high"), TableValue(interval.high));
    EXPECT_EQ(value(exploration, 0, "pu21_psnr_db_low"), TableValue());
    EXPECT_EQ(value(exploration, 0, "slots_per_second"), TableValue(200.0));
    EXPECT_EQ(value(exploration, 0, "rank"), TableValue("1"));
    EXPECT_EQ(value(exploration, 1, "rank"), TableValue("2"));
    // More seeds: only those are new. One seed: as ever.
    EXPECT_EQ(explored(options_of(4), psnr).counts().run, 2);
    const Exploration once = explored(options_of(1), psnr);
    EXPECT_EQ(once.counts().run, 0);
    EXPECT_EQ(value(once, 0, "psnr_db"), TableValue(30.0));
    EXPECT_EQ(value(once, 0, "rank"), TableValue("no such column"));
    EXPECT_EQ(value(once, 0, "psnr_db_low"), TableValue("no such column"));
}

/// Rates and amounts that cost something, and time.
bool should_be_little(std::string_view figure) {
    return figure.find("megabits") != figure.npos || figure == "energy_uj_per_slot" ||
           figure == "samples_per_voxel" || figure.starts_with("decode_");
}

TEST_F(ExplorationTest, ARankByWhatShouldBeLittleKeepsTheLeastAndByOthersTheMost) {
    write_space(kNoise);
    for (const FigureColumn& rank : kFigureColumns) {
        std::filesystem::remove_all(folder_ / "results");
        const Exploration exploration = explored_by(rank, options_of(1, 100));
        const std::uint64_t best = should_be_little(rank.name) ? 0 : 1;
        EXPECT_EQ(exploration.best_first(), (std::vector{best, 1 - best})) << rank.name;
        EXPECT_EQ(exploration.points()[best].slots, 24) << rank.name;
        EXPECT_EQ(exploration.points()[1 - best].slots, 12) << rank.name;
    }
}

TEST_F(ExplorationTest, OfWhatShouldBeLittleTheLeastRanksFirst) {
    write_space(kNoise);
    for (const FigureColumn& rank : kFigureColumns) {
        const Exploration exploration = explored_by(rank, options_of(3));
        const bool little = should_be_little(rank.name);
        EXPECT_EQ(value(exploration, 0, "rank"), TableValue(little ? "1" : "2")) << rank.name;
        EXPECT_EQ(value(exploration, 1, "rank"), TableValue(little ? "2" : "1")) << rank.name;
    }
}

TEST_F(ExplorationTest, APointIsARowWhenAllItsSeedsAreKnown) {
    write_space(kNoise);
    Exploration exploration = begun(options_of(2));
    exploration.next_rung();
    EXPECT_EQ(exploration.due(), (std::vector<std::uint64_t>{0, 1, 2, 3}));
    ASSERT_NE(exploration.begin(0), nullptr);
    put(exploration, 0, 30);
    EXPECT_FALSE(exploration.points()[0].touched);
    ASSERT_NE(exploration.begin(1), nullptr);
    put(exploration, 1, 31);
    EXPECT_EQ(exploration.points()[0].figures.value().psnr_db, 30.5);
    ASSERT_NE(exploration.begin(2), nullptr);
    exploration.fail(2, "impossible");
    EXPECT_EQ(exploration.begin(3), nullptr);
    EXPECT_EQ(value(exploration, 1, "problem"), TableValue("impossible"));
    EXPECT_EQ(exploration.counts().failed, 1);
}

TEST_F(ExplorationTest, WorkIsThatOfTheMethodOnThePixelsThatAreLeft) {
    write_space("binning = [1, 2]\n");
    ExploreOptions options;
    options.replaced = {{"method", {"naive", "best"}}};
    Exploration exploration = begun(options);
    exploration.next_rung();
    // Points: naive, naive of half the rows and columns, best, best of these.
    EXPECT_DOUBLE_EQ(exploration.work_of(0), 4 * exploration.work_of(1));
    EXPECT_DOUBLE_EQ(exploration.work_of(2), 4 * exploration.work_of(3));
    const double costs = named(DecodeMethod::kBest).voxel_us - named(DecodeMethod::kNaive).voxel_us;
    EXPECT_DOUBLE_EQ(exploration.work_of(2) - exploration.work_of(0), costs * exploration.slots());
}

TEST_F(ExplorationTest, SeedsCountInTheBudget) {
    write_space(kNoise);
    // Two points of two seeds with half a clip, then one point of two seeds with a whole one.
    const Exploration exploration = explored(options_of(2, 4), noisy_psnr);
    EXPECT_EQ(exploration.spent(), 4);
    EXPECT_EQ(exploration.most_trials(), 6);
    EXPECT_EQ(exploration.points()[0].slots, 24);
    EXPECT_EQ(explored(options_of(2, 3.5), noisy_psnr).spent(), 2);
}

TEST_F(ExplorationTest, MeansOverFootageHaveIntervalsAndRanksOverFootage) {
    write_space("footage = ['pan', 'roll', 'still']\n" + kNoise);
    // Points 0, 2, 4 are those of the first noise; the second one is worse by 0.1 each.
    const Psnr psnr = [](std::uint64_t point, std::uint64_t seed, int) {
        return 30 + 3.0 * static_cast<double>(point / 2) - 0.125 * static_cast<double>(point % 2) +
               static_cast<double>(seed);
    };
    const Exploration exploration = explored(options_of(2), psnr);
    const std::string table = footage_table(exploration);
    const MeanInterval interval = mean_interval(std::vector{30.5, 33.5, 36.5});
    EXPECT_EQ(table.find("sensor,schedule,method,seed,sensor.read_noise_e,psnr_db,psnr_db_low,"),
              0);
    expect_parts(table,
                 {"\npaper,random,naive,1,5,33.5,", ",1\npaper,random,naive,1,20,33.375,", ",2\n"});
    const auto ends = table.find("5,33.5,");
    EXPECT_NEAR(std::stod(table.substr(ends + 7)), interval.low, 1e-9);
    write_space(kNoise);
    EXPECT_EQ(footage_table(explored(options_of(1), psnr)), "");
}

TEST_F(ExplorationTest, RanksAreThoseOfEachFootage) {
    write_space("footage = ['pan', 'roll']\n" + kNoise);
    const Psnr psnr = [](std::uint64_t point, std::uint64_t seed, int) {
        const double values[4][3] = {{30, 31, 32}, {30.1, 30.9, 32}, {20, 21, 22}, {25, 26, 27}};
        return values[point][seed];
    };
    const Exploration exploration = explored(options_of(3), psnr);
    std::string ranks;
    for (const ExploredPoint& point : exploration.points()) ranks += text_of(point.rank) + " ";
    EXPECT_EQ(ranks, "1= 1= 2 1 ");
}

}  // namespace
}  // namespace stipple
