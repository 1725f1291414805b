#include "study/explore/trial.h"

#include <gtest/gtest.h>

#include <string>

#include "readout/schedules/tiled_schedule.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

bool keep_going() {
    return true;
}

/// By trying all exposures of a running sensor: those begun before its first slot too.
bool is_whole(const ExposureSchedule& schedule, int phase, int slots, int slot) {
    if (slot < phase) return false;
    const int period = schedule.period_slots();
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col)
            for (const Exposure& exposure : schedule.exposures(row, col))
                for (int k = -2; k <= slots / period + 1; ++k) {
                    const int begin = phase + static_cast<int>(exposure.first_slot) + k * period;
                    const int end = begin + exposure.span_slots();
                    const bool is_cut = begin < phase || end > slots;
                    if (is_cut && slot >= begin && slot < end) return false;
                }
    return true;
}

TEST(ComparedSlotsTest, TheEndsOfTheClipCutFrames) {
    // Frames of 12 slots: the third one of 32 is cut.
    EXPECT_EQ(whole_slots(full_schedule(12, 12), 0, 32), (ComparedSlots{0, 24}));
    EXPECT_EQ(whole_slots(full_schedule(12, 12), 0, 36), (ComparedSlots{0, 36}));
    EXPECT_EQ(whole_slots(full_schedule(4, 4), 0, 32), (ComparedSlots{0, 32}));
    // Exposures of 1 slot are never cut; a sensor that begins later has nothing before.
    EXPECT_EQ(whole_slots(full_schedule(1, 4), 3, 30), (ComparedSlots{3, 30}));
    EXPECT_EQ(whole_slots(full_schedule(4, 4), 3, 32), (ComparedSlots{3, 31}));
}

TEST(ComparedSlotsTest, AreThoseThatNoCutExposureTouches) {
    const int lengths[] = {1, 2, 4, 8};
    const ExposureSchedule random = random_schedule(6, 7, lengths, 3);
    for (const ExposureSchedule& schedule : {random, full_schedule(3, 5), full_schedule(12, 12)})
        for (const int phase : {0, 2})
            for (const int slots : {30, 32, 45}) {
                const ComparedSlots range = whole_slots(schedule, phase, slots);
                ASSERT_LT(range.begin, range.end);
                for (int slot = 0; slot < slots; ++slot)
                    EXPECT_EQ(is_whole(schedule, phase, slots, slot),
                              slot >= range.begin && slot < range.end)
                        << "phase " << phase << ", slot " << slot << " of " << slots;
            }
}

ComparedSlots compared(const std::string& systems, int slots, const std::string& clip = "",
                       const std::string& only = "") {
    Space space = parse_space("[axes]\nsensor = 'paper'\n" + systems + "[clip]\n" + clip, "s.toml");
    if (!only.empty()) space.replace({"system", {only}});
    const TrialLight light{FluxVideo(slots, {8, 8, 1}), {}};
    return compared_slots(space, light, 1000, keep_going);
}

const std::string kSystems = R"(
[[systems]]
name = "frames"
schedule = "full1x"
method = "fast"
[[systems]]
name = "rig"
rig = "tocci2011_slow"
method = "fast"
[[systems]]
name = "impossible"
schedule = "nosuch"
method = "fast"
)";

TEST(ComparedSlotsTest, AllPointsOfASpaceCompareTheSame) {
    EXPECT_EQ(compared("schedule = 'full1x'\n", 32), (ComparedSlots{4, 28}));  // the margin
    EXPECT_EQ(compared("schedule = ['full1x', 'full4x']\nmethod = ['naive', 'fast']\n", 30),
              (ComparedSlots{4, 26}));
    EXPECT_EQ(compared(kSystems, 32), (ComparedSlots{4, 24}));
    EXPECT_EQ(compared(kSystems, 32, "", "frames"), (ComparedSlots{4, 24}));
}

TEST(ComparedSlotsTest, OfShortClipsTheMarginAloneIsLeftOut) {
    // Of 16 slots, exposures of up to 8 slots leave at most slots 7 and 8.
    EXPECT_EQ(compared("schedule = 'random'\n", 16), (ComparedSlots{4, 12}));
    EXPECT_GE(compared("schedule = 'random'\n", 36).begin, 5);
}

TEST(ComparedSlotsTest, ASpaceMayNameThem) {
    EXPECT_EQ(compared(kSystems, 32, "compared = [2, 30]\n"), (ComparedSlots{2, 30}));
    EXPECT_EQ(compared(kSystems, 16, "compared = [2, 30]\n"), (ComparedSlots{2, 16}));
    for (const char* range : {"[3]", "[3, 3]", "[-1, 3]", "4", "[0, 1.5]", "['a', 4]"})
        expect_parts(message_of<InputError>([&] {
                         (void)compared(kSystems, 32, std::string("compared = ") + range + "\n");
                     }),
                     {"s.toml: clip.compared"});
}

}  // namespace
}  // namespace stipple
