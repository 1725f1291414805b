#include "stream/stream_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "core/exposure_schedule.h"

namespace stipple {
namespace {

TEST(StreamFiguresTest, AnUndamagedStreamHasNoDamageText) {
    StreamReport report;
    report.slots = 3;
    EXPECT_TRUE(undamaged(report));
    EXPECT_EQ(damage_text(report), "");
    report.tail_bytes = 7;
    EXPECT_FALSE(undamaged(report));
    EXPECT_EQ(damage_text(report),
              "the stream is cut off: 3 slots are whole, then it ends within a packet, of which "
              "there are 7 bytes");
}

TEST(StreamFiguresTest, DamageTextNamesTenPlacesAndCountsTheOthers) {
    StreamReport report;
    report.slots = 40;
    report.missing_slots = 12;
    report.unlisted_damage = 5;
    for (std::uint64_t place = 0; place < 12; ++place)
        report.damage.push_back({.offset = 100 * place, .bytes = 8, .cause = "wrong CRC"});
    const std::string text = damage_text(report);
    EXPECT_TRUE(text.starts_with("the stream is damaged; 12 of 40 slots are incomplete\n"));
    EXPECT_NE(text.find("\n  byte 900: wrong CRC, 8 bytes skipped"), std::string::npos);
    EXPECT_EQ(text.find("byte 1000"), std::string::npos);
    EXPECT_TRUE(text.ends_with("\n  and 7 more"));
}

TEST(StreamFiguresTest, TextsOnADecodedStreamAreEmptyWhereNothingIsAmiss) {
    StreamReport report;
    report.samples = 1;
    report.complete = true;
    EXPECT_EQ(decoded_damage_text(report, "\n  a hint"), "");
    EXPECT_EQ(no_sample_text(report), "");
    EXPECT_EQ(no_end_text(report), "");
    report.complete = false;
    EXPECT_TRUE(no_end_text(report).starts_with("has no end marker"));
    report.samples = 0;
    EXPECT_TRUE(no_sample_text(report).starts_with("holds no sample"));
    report.tail_bytes = 7;  // told by the text on the damage
    EXPECT_EQ(no_end_text(report), "");
    EXPECT_EQ(decoded_damage_text(report, "\n  a hint"),
              damage_text(report) + "\n  a hint\n  the output contains the undamaged part");
}

// A reader with ReadPolicy::kCounts keeps one pixel of a random schedule, whose tile is the array.
TEST(StreamFiguresTest, TheTileOfARandomScheduleIsTheArray) {
    StreamHeader header{.shape = FrameShape{.rows = 6, .cols = 8, .planes = 1},
                        .calibration = {},
                        .schedule = {1, 1, 1, {0, 1}, {{0, open_without_gap(1)}}},
                        .schedule_source = {},
                        .schedule_name = "one",
                        .provenance = {}};
    EXPECT_EQ(tile_shape_of(header).rows, 1);
    std::vector<std::string> names;
    const auto add = [&](const char* name, const auto& /*value*/) { names.emplace_back(name); };
    visit_schedule_figures(header, add);
    EXPECT_EQ(std::ranges::count(names, "seed"), 0);
    header.schedule_source.kind = ScheduleSource::Kind::kRandom;
    EXPECT_EQ(tile_shape_of(header).rows, 6);
    EXPECT_EQ(tile_shape_of(header).cols, 8);
    names.clear();
    visit_schedule_figures(header, add);
    EXPECT_EQ(std::ranges::count(names, "seed"), 1);
}

}  // namespace
}  // namespace stipple
