#include "decoder/block_partition.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "decoder/data_prox.h"

namespace stipple {
namespace {

TEST(BlockPartitionTest, CoresOfSlotsFollowEachOtherAndHalosStayInside) {
    for (std::int64_t slots = 1; slots < 300; ++slots) {
        std::int64_t done = 0, blocks = 0;
        while (done < slots) {
            ASSERT_EQ(done, block_begin(blocks++));
            const HaloRange s = slot_range(done, slots);
            ASSERT_EQ(s.core_begin, done);
            ASSERT_GT(s.core_end, s.core_begin);
            ASSERT_LE(s.core_end - s.core_begin, kCoreSlots + kRemainderSlots);
            ASSERT_EQ(s.begin, std::max<std::int64_t>(0, done - kHaloSlots));
            ASSERT_EQ(s.end, std::min(s.core_end + kHaloSlots, slots));
            done = s.core_end;
        }
        ASSERT_EQ(done, slots);
        ASSERT_EQ(blocks, block_count(slots));
    }
    EXPECT_EQ(block_count(0), 0);
}

TEST(BlockPartitionTest, ABlockIsTheSameWhateverFollowsIt) {
    const std::int64_t known = 96 + kCoreSlots + kRemainderSlots + 1;
    for (const std::int64_t slots : {known, known + 1, known + 1000}) {
        const HaloRange s = slot_range(96, slots);
        EXPECT_EQ(s.core_end, 96 + kCoreSlots);
        EXPECT_EQ(s.end, 96 + kCoreSlots + kHaloSlots);
    }
}

TEST(BlockPartitionTest, HalosHoldTheLongestExposureUpToALimit) {
    EXPECT_EQ(halo_slots(0), kHaloSlots);
    EXPECT_EQ(halo_slots(9), 8);
    EXPECT_EQ(halo_slots(10), 9);
    EXPECT_EQ(halo_slots(33), 32);
    EXPECT_EQ(halo_slots(64), 32);
    const HaloRange s = slot_range(96, 500, 32);
    EXPECT_EQ(s.begin, 64);
    EXPECT_EQ(s.end, 96 + kCoreSlots + 32);
    // The last block, and one with two halos, fit the run of `data_prox`.
    EXPECT_LE(kCoreSlots + kRemainderSlots + kMaxHaloSlots, kMaxRunSlots);
    EXPECT_LE(kCoreSlots + 2 * kMaxHaloSlots, kMaxRunSlots);
}

TEST(BlockPartitionTest, TilesCoverEveryPixelOnce) {
    for (const FrameShape shape :
         {FrameShape{1, 1, 1}, FrameShape{480, 640, 3}, FrameShape{1080, 1920, 3},
          FrameShape{3000, 11, 4}, FrameShape{1, 65535, 3}, FrameShape{4000, 6000, 1}}) {
        std::vector<int> count(shape.pixels());
        for (const auto& [rows, cols] : frame_tiles(shape)) {
            const auto sites = (rows.core_end - rows.core_begin) *
                               (cols.core_end - cols.core_begin) * shape.planes;
            EXPECT_LE(sites, 1 << 20);
            EXPECT_TRUE(rows.begin >= 0 && rows.begin <= rows.core_begin);
            EXPECT_TRUE(rows.end <= shape.rows && rows.end >= rows.core_end);
            EXPECT_TRUE(cols.begin >= 0 && cols.begin <= cols.core_begin);
            EXPECT_TRUE(cols.end <= shape.cols && cols.end >= cols.core_end);
            for (auto row = rows.core_begin; row < rows.core_end; ++row)
                for (auto col = cols.core_begin; col < cols.core_end; ++col)
                    ++count[static_cast<std::size_t>(row * shape.cols + col)];
        }
        EXPECT_TRUE(std::ranges::all_of(count, [](int n) { return n == 1; }));
    }
    EXPECT_EQ(frame_tiles({480, 640, 3}).size(), 1U);
}

}  // namespace
}  // namespace stipple
