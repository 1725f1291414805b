#include "capture/serve/gvsp_faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace stipple {
namespace {

using Packets = std::vector<std::uint32_t>;

TEST(GvspFaultsTest, WithoutFaultsPacketsGoInOrder) {
    Packets all(100);
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_EQ(packets_to_send({}, 3, 100), all);
}

TEST(GvspFaultsTest, ReorderedPacketsAreAllThere) {
    GvspFaults faults;
    faults.reorder = true;
    Packets sent = packets_to_send(faults, 0, 10);
    EXPECT_EQ(sent, (Packets{0, 2, 1, 3, 4, 6, 5, 7, 8, 9}));
}

// Of 100 000 packets a share p is hit 100 000 p times, standard deviation below sqrt(100 000 p).
TEST(GvspFaultsTest, SharesAreKeptAndRepeatable) {
    GvspFaults faults;
    faults.drop = 0.04;
    faults.duplicate = 0.01;
    std::size_t sent = 0;
    std::size_t twice = 0;
    for (std::uint64_t frame = 0; frame < 100; ++frame) {
        const Packets order = packets_to_send(faults, frame, 1000);
        EXPECT_EQ(order, packets_to_send(faults, frame, 1000));
        for (std::size_t i = 1; i < order.size(); ++i) twice += order[i] == order[i - 1] ? 1U : 0U;
        sent += order.size();
    }
    const double dropped = 100000.0 - static_cast<double>(sent - twice);
    EXPECT_NEAR(dropped, 4000, 6 * 64);
    EXPECT_NEAR(static_cast<double>(twice), 960, 6 * 31);
}

TEST(GvspFaultsTest, LostPacketsAreNeverSent) {
    GvspFaults faults;
    faults.lose = 0.1;
    const Packets order = packets_to_send(faults, 7, 1000);
    for (std::uint32_t i = 0; i < 1000; ++i)
        EXPECT_EQ(is_lost(faults, 7, i), std::count(order.begin(), order.end(), i) == 0) << i;
}

TEST(GvspFaultsTest, AGapLeavesOutNumbers) {
    GvspFaults faults;
    EXPECT_EQ(number_with_gap(faults, 5), 5U);
    faults.gap_at = 5;
    faults.gap_frames = 3;
    EXPECT_EQ(number_with_gap(faults, 4), 4U);
    EXPECT_EQ(number_with_gap(faults, 5), 8U);
}

}  // namespace
}  // namespace stipple
