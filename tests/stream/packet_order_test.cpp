#include "stream/packet_order.h"

#include <gtest/gtest.h>

namespace stipple {
namespace {

constexpr int kRows = 4;

TEST(PacketOrderTest, BandsOfASlotLeadToTheNextSlot) {
    PacketOrder order(kRows);
    order.advance(1);
    EXPECT_EQ(order.expected(), (StreamPosition{0, 1}));
    order.advance(3);
    EXPECT_EQ(order.expected(), (StreamPosition{1, 0}));
    EXPECT_EQ(order.missing_slots(), 0);
}

TEST(PacketOrderTest, CountsEachSlotWithMissingRowsOnce) {
    PacketOrder order(kRows);
    order.skip_to({0, 0});
    EXPECT_EQ(order.missing_slots(), 0);
    order.skip_to({0, 1});  // row 0 of slot 0
    EXPECT_EQ(order.missing_slots(), 1);
    order.advance(1);
    order.skip_to({0, 3});  // row 2 of the same slot
    EXPECT_EQ(order.missing_slots(), 1);
    order.skip_to({3, 0});  // row 3 of slot 0, slots 1 and 2
    EXPECT_EQ(order.missing_slots(), 3);
    order.skip_to({5, 2});  // slots 3 and 4, two rows of slot 5
    EXPECT_EQ(order.missing_slots(), 6);
    EXPECT_EQ(order.expected(), (StreamPosition{5, 2}));
}

TEST(PacketOrderTest, NamesAGapByItsFirstAndLastRow) {
    PacketOrder order(kRows);
    EXPECT_EQ(order.missing_before({1, 0}), "slot 0 is missing");
    EXPECT_EQ(order.missing_before({3, 0}), "slots 0..2 are missing");
    EXPECT_EQ(order.missing_before({0, 2}), "rows 0..1 of slot 0 are missing");
    EXPECT_EQ(order.missing_before({2, 1}), "slot 0 from row 0 to slot 2 row 0 is missing");
    order.advance(1);
    EXPECT_EQ(order.missing_before({1, 0}), "rows 1..3 of slot 0 are missing");
    EXPECT_EQ(order.missing_before({2, 0}), "slot 0 from row 1 to slot 1 row 3 is missing");
}

}  // namespace
}  // namespace stipple
