#include "stream/slot_index.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

TEST(SlotIndexTest, KeepsEachSlotWhileThereIsRoom) {
    SlotIndex index(8);
    for (std::uint64_t slot = 0; slot < 8; ++slot) index.add({slot, 100 + slot});
    ASSERT_EQ(index.entries().size(), 8U);
    EXPECT_EQ(index.entries()[5].slot, 5U);
    EXPECT_EQ(index.entries()[5].offset, 105U);
}

TEST(SlotIndexTest, AnEndlessRecordingTakesBoundedMemory) {
    SlotIndex index(8);
    for (std::uint64_t slot = 0; slot < 1000; ++slot) index.add({slot, 2 * slot});
    // 1000 slots in at most 8 entries: every 128th.
    ASSERT_EQ(index.entries().size(), 8U);
    for (std::uint64_t i = 0; i < 8; ++i) {
        EXPECT_EQ(index.entries()[i].slot, 128 * i);
        EXPECT_EQ(index.entries()[i].offset, 256 * i);
    }
}

}  // namespace
}  // namespace stipple
