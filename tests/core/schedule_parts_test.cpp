#include "core/schedule_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tests/support/paper_schedule.h"

namespace stipple {
namespace {

constexpr int kRows = 4;
constexpr int kCols = 6;

/// A tile of 2 x 3 pixels: gaps between exposures, closed slots within, one that wraps around, and
/// a pixel without exposures.
ExposureSchedule gapped() {
    return {2,
            3,
            7,
            {0, 1, 3, 4, 4, 6, 7},
            {{5, 0b1011}, {0, 0b11}, {3, 0b101}, {6, 0b1}, {1, 0b111}, {4, 0b1}, {2, 0b1111111}}};
}

ExposureSchedule paper(std::uint64_t seed) {
    return random_schedule(kRows, kCols, kPaperExposureSlots, seed);
}

/// What a pixel does in a slot, from the exposures one by one.
struct Doing {
    bool open = false;
    bool read = false;
};

Doing doing(const SchedulePart& part, const PixelSlot& at) {
    const ExposureSchedule& s = *part.schedule;
    Doing result;
    for (const Exposure& e : s.exposures(at.row % s.tile_rows(), at.col % s.tile_cols()))
        for (int i = 0; i < e.span_slots(); ++i) {
            const bool begun = part.first_slot > 0 || at.slot >= i;
            if (!begun ||
                (std::int64_t{e.first_slot} + i) % s.period_slots() != at.slot % s.period_slots())
                continue;
            result.open = result.open || (e.open_slots >> static_cast<unsigned>(i) & 1U) != 0;
            result.read = result.read || i == e.span_slots() - 1;
        }
    return result;
}

/// The slots in which the exposures of a pixel are open, each read at its last one, from a charge
/// store that only a readout resets.
std::vector<std::vector<std::int64_t>> stored(const std::vector<SchedulePart>& parts, PixelSlot at,
                                              std::int64_t slots) {
    std::vector<std::vector<std::int64_t>> exposures;
    std::vector<std::int64_t> store;
    for (at.slot = 0; at.slot < slots; ++at.slot) {
        const Doing now = doing(parts[part_at(parts, at.slot)], at);
        if (now.open) store.push_back(at.slot);
        if (now.read) exposures.push_back(std::exchange(store, {}));
    }
    return exposures;
}

std::vector<std::int64_t> slots_of(const ReadExposure& exposure) {
    std::vector<std::int64_t> slots;
    for (int i = 0; i < 64; ++i)
        if ((exposure.open_slots >> static_cast<unsigned>(i) & 1U) != 0)
            slots.push_back(exposure.first_slot + i);
    return slots;
}

void expect_as_stored(const std::vector<SchedulePart>& parts, std::int64_t slots) {
    for (PixelSlot at; at.row < kRows; ++at.row)
        for (at.col = 0; at.col < kCols; ++at.col)
            for (const auto& expected : stored(parts, at, slots)) {
                at.slot = expected.back();
                const auto read = read_exposure(parts, at);
                ASSERT_TRUE(read);
                EXPECT_EQ(slots_of(*read), expected) << at.row << ' ' << at.col << ' ' << at.slot;
            }
}

TEST(SchedulePartsTest, AnExposureHasTheOpenSlotsOfAStoreThatOnlyReadoutsReset) {
    const ExposureSchedule gaps = gapped(), first = paper(1), second = paper(2);
    for (const ExposureSchedule* a : {&gaps, &first})
        for (const ExposureSchedule* b : {&second, &gaps})
            for (const ExposureSchedule* c : {&first, &gaps})
                for (const std::int64_t slot : {1, 2, 7, 30, 31, 32, 40})
                    for (const std::int64_t later : {1, 2, 5, 16})
                        expect_as_stored({{a}, {b, slot}, {c, slot + later}}, 80);
}

TEST(SchedulePartsTest, WithoutGapsEachSlotIsInOneExposure) {
    const ExposureSchedule first = paper(1), second = paper(2);
    const std::vector<SchedulePart> parts{{&first}, {&second, 21}, {&first, 24}};
    for (PixelSlot at; at.row < kRows; ++at.row)
        for (at.col = 0; at.col < kCols; ++at.col) {
            std::vector<int> times(100);
            for (at.slot = 0; at.slot < 100; ++at.slot) {
                if (!doing(parts[part_at(parts, at.slot)], at).read) continue;
                for (const std::int64_t slot : slots_of(read_exposure(parts, at).value()))
                    ++times[static_cast<std::size_t>(slot)];
            }
            EXPECT_EQ(std::count(times.begin() + 8, times.end() - 8, 1), 84);
        }
}

TEST(SchedulePartsTest, TheDuePixelsAfterASwitchAreAllOfTheNewSchedule) {
    const ExposureSchedule first = paper(1), gaps = gapped();
    const std::vector<SchedulePart> parts{{&first}, {&gaps, 1}};
    for (PixelSlot at{.slot = 1}; at.slot < 20; ++at.slot)
        for (at.row = 0; at.row < kRows; ++at.row) {
            std::vector<int> due;
            for_each_readout(gaps, readout_slot(parts[1], at.slot), at.row, kCols,
                             [&](int col, int) { due.push_back(col); });
            std::vector<int> expected;
            for (at.col = 0; at.col < kCols; ++at.col)
                if (doing(parts[1], at).read) expected.push_back(at.col);
            EXPECT_EQ(due, expected);
        }
}

TEST(SchedulePartsTest, ExposuresFromBeforeAnUnknownPartAreUnknown) {
    const ExposureSchedule first = paper(1), second = paper(2);
    std::vector<SchedulePart> parts{{&first}, {&second, 20}, {&first, 40}};
    for (const bool follows : {true, false}) {
        parts[1].follows = follows;
        int unknown = 0;
        for (PixelSlot at{.slot = 20}; at.slot < 60; ++at.slot)
            for (at.row = 0; at.row < kRows; ++at.row)
                for (at.col = 0; at.col < kCols; ++at.col)
                    if (doing(parts[part_at(parts, at.slot)], at).read)
                        unknown += read_exposure(parts, at) ? 0 : 1;
        EXPECT_EQ(unknown, follows ? 0 : kRows * kCols);
    }
}

/// The most slots of an exposure that is the first to be read after the last switch.
std::int64_t longest_stored(const std::vector<SchedulePart>& parts, std::int64_t slots) {
    std::int64_t longest = 0;
    for (PixelSlot at; at.row < kRows; ++at.row)
        for (at.col = 0; at.col < kCols; ++at.col)
            for (const auto& exposure : stored(parts, at, slots)) {
                if (exposure.back() < parts.back().first_slot) continue;
                longest = std::max(longest, exposure.back() - exposure.front() + 1);
                break;
            }
    return longest;
}

TEST(SchedulePartsTest, TheLongestExposureIsThatOfTheStores) {
    const ExposureSchedule gaps = gapped(), first = paper(1), second = paper(2);
    const ExposureSchedule long_one{1, 1, 40, {0, 1}, {{35, open_without_gap(40)}}};
    for (const ExposureSchedule* b : {&second, &gaps, &long_one})
        for (const ExposureSchedule* c : {&first, &gaps, &long_one})
            for (const std::int64_t slot : {1, 7, 30, 75})
                for (const std::int64_t later : {1, 5, 39}) {
                    const std::vector<SchedulePart> parts{{&first}, {b, slot}, {c, slot + later}};
                    UnreadSlots unread({kRows, kCols, 1});
                    unread.pass(std::span(parts).first(2));
                    unread.pass(parts);
                    const auto longest = unread.longest(parts.back());
                    const std::int64_t expected = longest_stored(parts, 200);
                    EXPECT_TRUE(longest.slots == expected || (longest.slots > 64 && expected > 64))
                        << longest.slots << ' ' << expected;
                }
}

}  // namespace
}  // namespace stipple
