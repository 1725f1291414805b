#include "readout/schedules/code_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "readout/schedules/schedule_catalogue.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/readout/gapped_schedule.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

ExposureSchedule one_pixel(const std::string& code) {
    return code_schedule({1, 1, static_cast<int>(code.size())}, std::vector{code}, "file: code");
}

/// Exposures of one pixel in a period of `period` slots.
ExposureSchedule of(int period, std::vector<Exposure> exposures) {
    return {1, 1, period, {0, static_cast<std::uint32_t>(exposures.size())}, exposures};
}

std::string problem_of(TileSize size, const std::vector<std::string>& code) {
    return message_of<InputError>([&] { return code_schedule(size, code, "file: code"); });
}

TEST(CodeScheduleTest, ReadsExposuresThatFollowEachOther) {
    EXPECT_EQ(one_pixel("AaaaAa"), of(6, {{0, 0b1111}, {4, 0b11}}));
    EXPECT_EQ(one_pixel("AAA"), of(3, {{0, 1}, {1, 1}, {2, 1}}));
    EXPECT_EQ(one_pixel("......"), of(6, {}));
}

TEST(CodeScheduleTest, ReadsGapsWithinAndBetweenExposures) {
    EXPECT_EQ(one_pixel("Aa..a.Aa"), of(8, {{0, 0b10011}, {6, 0b11}}));
}

TEST(CodeScheduleTest, GoesOnAroundThePeriod) {
    EXPECT_EQ(one_pixel("a.aA.."), of(6, {{3, 0b101001}}));
    EXPECT_EQ(one_pixel("aAaAa"), of(5, {{1, 0b11}, {3, 0b111}}));
}

TEST(CodeScheduleTest, ReadsTheSecondStoreOnItsOwn) {
    EXPECT_EQ(one_pixel("ABabba"), of(6, {{0, 0b100101}, {1, 0b1101}}));
}

TEST(CodeScheduleTest, GoesPixelByPixelAlongTheRows) {
    const std::vector<std::string> code = {"A.", ".A", "Aa", ".."};
    EXPECT_EQ(code_schedule({2, 2, 2}, code, ""),
              ExposureSchedule(2, 2, 2, {0, 1, 2, 3, 3}, {{0, 1}, {1, 1}, {0, 0b11}}));
}

TEST(CodeScheduleTest, NamesPixelAndSlotOfWhatIsWrong) {
    expect_parts(problem_of({1, 2, 3}, {"A..", "A.x"}),
                 {"file: code", "pixel (0, 1) slot 2", "'x' is none of . A a B b"});
    expect_parts(problem_of({2, 1, 3}, {"A..", ".a."}),
                 {"pixel (1, 0) slot 1", "'a' goes on", "no 'A' begins"});
    expect_parts(problem_of({1, 1, 2}, {"Ab"}), {"pixel (0, 0) slot 1", "no 'B' begins"});
    expect_parts(problem_of({2, 1, 3}, {"A..", "A."}), {"pixel (1, 0)", "has 2 slots"});
    expect_parts(problem_of({1, 3, 1}, {"A", "A"}), {"holds 2 pixels", "1 x 3 has 3"});
    expect_parts(problem_of({1, 1, 1}, {"\n"}), {"slot 0", "'\\x0a'"});
    // Slots 70 .. 79 and 0 .. 54: 65 of 80.
    const std::string long_one = std::string(55, 'a') + std::string(15, '.') + "Aaaaaaaaaa";
    expect_parts(problem_of({1, 1, 80}, {long_one}), {"pixel (0, 0) slot 70", "spans 65", "64"});
    EXPECT_EQ(one_pixel(long_one.substr(0, 54) + "." + long_one.substr(55)),
              of(80, {{70, ~std::uint64_t{0}}}));
}

/// The schedule that a file with this text describes.
ExposureSchedule read(const std::string& text) {
    const TemporaryFolder folder;
    write_text(folder / "code.toml", text);
    Config config(folder / "code.toml", {});
    const NamedSchedule named = read_schedule(config, {.rows = 3, .cols = 3, .planes = 1}, 1);
    config.reject_unknown_keys();
    EXPECT_EQ(named.name, "my \"own\" \\ code");
    return named.schedule;
}

TEST(CodeScheduleTest, ReadsWhatItWrites) {
    const std::string name = "my \"own\" \\ code";
    for (const ExposureSchedule& schedule :
         {random_schedule(7, 9, kPaperExposureSlots, 2), gapped_schedule(3, 5, 29, 1),
          gapped_schedule(16, 12, 80, 2), interleaved_schedule(5, 7, 9, 3), full_schedule(64, 100),
          ExposureSchedule(1, 1, 3, {0, 0}, {})})
        EXPECT_EQ(read(code_text(schedule, name)), schedule);
}

TEST(CodeScheduleTest, WritesTwoPeriodsWhereStoresChangeSides) {
    const ExposureSchedule schedule = read(code_text(alternating_schedule(), "my \"own\" \\ code"));
    EXPECT_EQ(schedule.period_slots(), 12);
    for (int slot = 0; slot < 40; ++slot)
        EXPECT_EQ(count_due(schedule, slot, 0, 3, 3),
                  count_due(alternating_schedule(), slot, 0, 3, 3));
}

TEST(CodeScheduleTest, RefusesToWriteWhatACodeCannotHold) {
    const ExposureSchedule three(1, 1, 9, {0, 3}, {{0, 0b1001}, {1, 0b1001}, {2, 0b1001}});
    EXPECT_THROW(static_cast<void>(code_text(three, "")), InputError);
    expect_parts(message_of<InputError>([] {
                     return code_text(random_schedule(1100, 1100, kPaperExposureSlots, 1), "");
                 }),
                 {"1100 x 1100", "15 slots", "smaller"});
}

TEST(CodeScheduleTest, HoldsWeightsInSixteenBits) {
    // 1, 1/65535 and 0x8000 / 0xFFFF; an open slot is never rounded to 0.
    const ExposureSchedule grey = read(
        "kind = \"code\"\nname = \"my \\\"own\\\" \\\\ code\"\n"
        "tile_cols = 2\nperiod_slots = 2\ncode = [\"Aa\", \".A\"]\n"
        "weights = [\"FFFF0001\", \"00008000\"]");
    const float half = 32768.0F / 65535;
    EXPECT_TRUE(std::ranges::equal(grey.weights(), std::vector<float>{1, 0, 1.0F / 65535, half}));
    EXPECT_EQ(read(code_text(grey, "my \"own\" \\ code")), grey);
    ExposureSchedule faint = grey;
    faint.set_weights({1, 0, 1e-6F, 1});
    EXPECT_EQ(read(code_text(faint, "my \"own\" \\ code")).weight(1, 0, 0), 1.0F / 65535);
    faint.set_weights({1, 0, 2, 1});
    expect_parts(message_of<InputError>([&] { return code_text(faint, "a"); }),
                 {"pixel (0, 0) slot 1", "2 is above 1"});
}

TEST(CodeScheduleTest, NamesThePixelOfWrongWeights) {
    const auto problem = [](const std::vector<std::string>& texts) {
        return message_of<InputError>([&] { return code_weights({1, 2, 1}, texts, "file: w"); });
    };
    expect_parts(problem({"FFFF"}), {"file: w", "holds 1 pixels", "1 x 2 has 2"});
    expect_parts(problem({"FFFF", "FFF"}), {"pixel (0, 1)", "4 hexadecimal digits"});
    expect_parts(problem({"00G0", "FFFF"}), {"pixel (0, 0)"});
}

}  // namespace
}  // namespace stipple
