#include "study/report/run_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "stream/stream_reader.h"
#include "tests/study/report/recorded_clip.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using testing::HasSubstr;

constexpr FrameShape kShape{.rows = 64, .cols = 80, .planes = 3};
constexpr int kSlots = 24;

nlohmann::ordered_json data_of(const RunReport& report) {
    return nlohmann::ordered_json::parse(report.json());
}

/// A report of a stream whose truth is its only video.
struct SmallReport {
    explicit SmallReport(RunReportOptions options) : light(ramp(kSlots, kShape)) {
        record_clip(folder / "a.stipple", {}, light);
        report.emplace(options, kShape, &light);
        report->add_run(folder / "a.stipple", "a");
    }
    TemporaryFolder folder;
    FluxVideo light;
    std::optional<RunReport> report;
};

TEST(RunReportTest, PicturesAreLeftOutUntilTheFileFits) {
    SmallReport whole({});
    whole.report->fit();
    EXPECT_EQ(data_of(*whole.report)["picture_step"], 1);
    EXPECT_TRUE(whole.report->notes().empty());
    const std::size_t bytes = whole.report->page().size();

    const std::size_t most = bytes - 1;
    SmallReport smaller({.max_bytes = most});
    smaller.report->fit();
    EXPECT_GT(data_of(*smaller.report)["picture_step"], 1);
    ASSERT_EQ(smaller.report->notes().size(), 1U);
    EXPECT_THAT(smaller.report->notes()[0], HasSubstr("to stay within"));
    EXPECT_LT(smaller.report->page().size(), most);
}

TEST(RunReportTest, ABoundThatCannotBeKeptIsRefused) {
    EXPECT_THROW(SmallReport({.max_bytes = 1000}), InputError);  // not even the samples
    SmallReport small({.max_bytes = 200'000});
    EXPECT_THROW(small.report->fit(), InputError);
}

TEST(RunReportTest, OnlyTheFirstSlotsAreShown) {
    SmallReport small({.slots = 10});
    const auto json = data_of(*small.report);
    EXPECT_EQ(json["slots"], 10);
    EXPECT_EQ(json["runs"][0]["loads"]["samples"].size(), 10U);
    EXPECT_THAT(small.report->notes()[0], HasSubstr("first 10 of 24 slots"));
}

TEST(RunReportTest, ACroppedReportSaysSo) {
    SmallReport small({.area = parse_area("16x8+4+2")});
    EXPECT_EQ(data_of(*small.report)["area"],
              nlohmann::ordered_json::parse(
                  R"({"rows":8,"cols":16,"planes":3,"first_row":2,"first_col":4})"));
    EXPECT_THAT(small.report->notes()[0], HasSubstr("16 x 8 of 80 x 64 pixels"));
}

TEST(RunReportTest, AStreamOfAnotherShapeIsRefused) {
    const TemporaryFolder folder;
    record_clip(folder / "a.stipple", {}, ramp(4, {.rows = 8, .cols = 8, .planes = 1}));
    RunReport report({}, kShape, nullptr);
    EXPECT_THROW(report.add_run(folder / "a.stipple", "a"), InputError);
}

TEST(RunReportTest, FiguresOfACameraAreJson) {
    SmallReport small({});
    EXPECT_TRUE(data_of(*small.report)["camera"].is_null());
    small.report->set_camera(R"({"measured":{"gain_e_per_dn":2.5}})");
    EXPECT_EQ(data_of(*small.report)["camera"]["measured"]["gain_e_per_dn"], 2.5);
    EXPECT_THROW(small.report->set_camera("{"), InputError);
    EXPECT_THAT(camera_page("a camera", "stipple", R"({"measured":{"gain_e_per_dn":2.5}})"),
                HasSubstr(R"("gain_e_per_dn":2.5)"));
}

TEST(RunReportTest, TheBrightestLightSaturatesTheShortestExposure) {
    const TemporaryFolder folder;
    // The paper's sensor saturates at 2000 electrons, light 1.0 is 1000 electrons a slot.
    for (const auto& [schedule, brightest] : {std::pair{"random", 2.0}, std::pair{"full4x", 0.5}}) {
        const auto file = folder / (std::string(schedule) + ".stipple");
        record_clip(file, {.schedule = schedule}, ramp(4, kShape));
        EXPECT_DOUBLE_EQ(brightest_light(StreamReader(file).header()), brightest);
    }
    // A pixel of a quarter of the responsivity takes four times as much, wherever it is in the
    // tile.
    StreamHeader header = StreamReader(folder / "random.stipple").header();
    for (const auto& [place, tile] : {std::pair{0, CalibrationTile{1, 2, {{0.25, 1}, {1, 1}}}},
                                      std::pair{1, CalibrationTile{1, 2, {{1, 1}, {0.25, 1}}}},
                                      std::pair{2, CalibrationTile{2, 1, {{1, 1}, {0.25, 1}}}}}) {
        header.calibration.tile = tile;
        EXPECT_DOUBLE_EQ(brightest_light(header), 8) << place;
    }
}

}  // namespace
}  // namespace stipple
