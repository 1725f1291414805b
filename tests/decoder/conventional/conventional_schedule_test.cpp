#include "decoder/conventional/conventional_schedule.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/stream/stream_bytes.h"

namespace stipple {
namespace {

/// A tile of two pixels that are open in the slots of two masks, with weights.
ExposureSchedule pair_of(std::uint64_t first, std::uint64_t second, std::vector<float> weights) {
    ExposureSchedule schedule(1, 2, 4, {0, 1, 2}, {{0, first}, {0, second}});
    if (!weights.empty()) schedule.set_weights(std::move(weights));
    return schedule;
}

TEST(ConventionalScheduleTest, HasTheSameExposuresInAllPixels) {
    EXPECT_TRUE(conventional(full_schedule(4, 4)));
    EXPECT_TRUE(conventional(full_schedule(1, 4)));
    EXPECT_TRUE(conventional(full_schedule(1, 1))) << "a frame in each slot";
    EXPECT_TRUE(conventional(pair_of(0b1011, 0b1011, {}))) << "a flutter shutter";
    EXPECT_TRUE(conventional({1, 2, 3, {0, 1, 1}, {{0, 1}}})) << "a column that is never read";
    EXPECT_TRUE(conventional({1, 1, 3, {0, 0}, {}})) << "nothing is read";
}

TEST(ConventionalScheduleTest, IsNotCoded) {
    EXPECT_FALSE(conventional(random_schedule(8, 8, kPaperExposureSlots, 1)));
    EXPECT_FALSE(conventional(tiled_schedule(8, 8, kPaperExposureSlots, 1)));
    EXPECT_FALSE(conventional({2, 1, 4, {0, 1, 2}, {{0, 1}, {1, 1}}})) << "a rolling shutter";
    EXPECT_FALSE(conventional({1, 1, 4, {0, 2}, {{0, 1}, {2, 3}}})) << "different lengths";
    EXPECT_FALSE(conventional({1, 1, 4, {0, 2}, {{0, 0b101}, {1, 0b101}}})) << "interleaved";
}

TEST(ConventionalScheduleTest, HasWeightsThatAreEqualUpToAFactor) {
    // Order (slot, col).
    EXPECT_TRUE(conventional(pair_of(3, 3, {0.5F, 0.1F, 1.0F, 0.2F, 0, 0, 0, 0})));
    EXPECT_FALSE(conventional(pair_of(3, 3, {0.5F, 0.2F, 1.0F, 0.2F, 0, 0, 0, 0})));
}

TEST(ConventionalScheduleTest, IsAlternatingWithTwoToFourExposureTimes) {
    EXPECT_TRUE(alternating({1, 1, 4, {0, 2}, {{0, 1}, {2, 3}}}));
    EXPECT_TRUE(alternating({1, 2, 4, {0, 2, 2}, {{0, 1}, {2, 3}}})) << "a column without samples";
    EXPECT_TRUE(alternating({1, 1, 10, {0, 4}, {{0, 1}, {1, 3}, {3, 7}, {6, 15}}}));
    EXPECT_FALSE(alternating({1, 1, 15, {0, 5}, {{0, 1}, {1, 3}, {3, 7}, {6, 15}, {10, 31}}}));
    EXPECT_FALSE(alternating(full_schedule(4, 4)));
    EXPECT_FALSE(alternating({1, 1, 8, {0, 2}, {{0, 3}, {3, 5}}})) << "2 open slots each";
    EXPECT_FALSE(alternating({1, 2, 4, {0, 1, 2}, {{0, 1}, {0, 3}}})) << "pixels differ";
    EXPECT_FALSE(alternating({1, 1, 3, {0, 0}, {}})) << "nothing is read";
}

TEST(ConventionalScheduleTest, TheErrorNamesStreamMethodAndRemedy) {
    EXPECT_NO_THROW(require_conventional(full_schedule(4, 4), "clip.stipple", "vbm4d"));
    expect_parts(message_of<InputError>([] {
                     require_conventional(tiled_schedule(8, 8, kPaperExposureSlots, 1),
                                          "clip.stipple", "vbm4d");
                 }),
                 {"clip.stipple: the method vbm4d", "full1x and full4x", "naive, fast or best"});
    expect_parts(
        message_of<InputError>(
            [] { require_alternating(full_schedule(4, 4), "clip.stipple", "kang2003"); }),
        {"clip.stipple: the method kang2003", "alternating and dol", "naive, fast or best"});
}

}  // namespace
}  // namespace stipple
