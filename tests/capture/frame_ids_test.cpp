#include "capture/frame_ids.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace stipple {
namespace {

constexpr std::uint64_t kGige = 65535;  // ids 1 to 65535

TEST(FrameIdsTest, TheFirstFrameHasIdZeroWhateverTheCameraCallsIt) {
    FrameIds ids(kGige);
    const auto step = ids.next(65401);
    EXPECT_EQ(step.id, 0U);
    EXPECT_EQ(step.lost, 0U);
    EXPECT_FALSE(step.restarted);
}

TEST(FrameIdsTest, AGigeCameraThatWrapsFrom65535To1LosesNothing) {
    FrameIds ids(kGige);
    std::uint64_t expected = 0;
    for (const std::uint64_t wire : {65533U, 65534U, 65535U, 1U, 2U, 3U}) {
        const auto step = ids.next(wire);
        EXPECT_EQ(step.id, expected++);
        EXPECT_EQ(step.lost, 0U);
    }
}

TEST(FrameIdsTest, AGapAcrossTheWrapHasItsTrueLength) {
    FrameIds ids(kGige);
    static_cast<void>(ids.next(65535));
    const auto step = ids.next(4);  // 1, 2, 3 are missing
    EXPECT_EQ(step.lost, 3U);
    EXPECT_EQ(step.id, 4U);
}

TEST(FrameIdsTest, RandomGapsOverManyWrapsAddUpToTheTrueCounter) {
    constexpr unsigned kSeed = 20261121;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    for (const std::uint64_t period : {std::uint64_t{65535}, std::uint64_t{1} << 32U}) {
        FrameIds ids(period);
        std::uint64_t truth = 1'000'000;
        const std::uint64_t first = truth;
        static_cast<void>(ids.next(truth % period));
        for (int i = 0; i < 1000; ++i) {
            const std::uint64_t gap = random() % (period / 2);
            truth += gap + 1;
            const auto step = ids.next(truth % period);
            ASSERT_EQ(step.lost, gap);
            ASSERT_EQ(step.id, truth - first);
        }
    }
}

TEST(FrameIdsTest, Ids64BitsWideNeedNoUnwrapping) {
    FrameIds ids(~std::uint64_t{0});
    static_cast<void>(ids.next(0));
    EXPECT_EQ(ids.next(std::uint64_t{1} << 40U).lost, (std::uint64_t{1} << 40U) - 1);
}

TEST(FrameIdsTest, ACounterThatBeginsAnewIsNoGap) {
    FrameIds ids(kGige);
    static_cast<void>(ids.next(500));
    const auto step = ids.next(1);
    EXPECT_TRUE(step.restarted);
    EXPECT_EQ(step.lost, 0U);
    EXPECT_EQ(step.id, 1U);
    EXPECT_EQ(ids.next(2).id, 2U);
}

TEST(FrameIdsTest, ARepeatedIdIsAFrameOfItsOwn) {
    FrameIds ids(kGige);
    static_cast<void>(ids.next(7));
    const auto step = ids.next(7);
    EXPECT_TRUE(step.restarted);
    EXPECT_EQ(step.id, 1U);
}

TEST(FrameIdsTest, AfterAReconnectionIdsGoOnBehindTheFramesThatWereMissed) {
    FrameIds ids(kGige);
    static_cast<void>(ids.next(10));
    ids.restart(std::uint64_t{1} << 32U, 40);
    const auto step = ids.next(0);
    EXPECT_EQ(step.id, 41U);
    EXPECT_EQ(step.lost, 0U);
    EXPECT_FALSE(step.restarted);
}

}  // namespace
}  // namespace stipple
