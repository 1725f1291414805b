#include "capture/camera.h"

#include <gtest/gtest.h>

#include <set>
#include <thread>

namespace stipple {
namespace {

TEST(FramePoolTest, ItsMemoryIsUsedAgain) {
    FramePool pool;
    pool.reserve(2, 1000);
    std::set<const std::uint8_t*> places;
    for (int i = 0; i < 10; ++i) {
        auto one = pool.take();
        auto other = pool.take();
        for (auto* const payload : {&one, &other}) {
            EXPECT_TRUE(payload->empty());
            payload->assign(1000, 7);
            places.insert(payload->data());
        }
        pool.give_back(std::move(one));
        pool.give_back(std::move(other));
    }
    EXPECT_EQ(places.size(), 2U);
    EXPECT_EQ(pool.misses(), 0U);
}

TEST(FramePoolTest, WithoutMemoryLeftItCountsMisses) {
    FramePool pool;
    EXPECT_EQ(pool.take().capacity(), 0U);
    pool.reserve(1, 1000);
    const auto payload = pool.take();
    EXPECT_GE(payload.capacity(), 1000U);
    EXPECT_EQ(pool.take().capacity(), 0U);
    EXPECT_EQ(pool.misses(), 2U);
}

TEST(FramePoolTest, ItKeepsNoMorePayloadsThanWereReserved) {
    FramePool pool;
    pool.reserve(1, 1000);
    for (int i = 0; i < 3; ++i) pool.give_back(std::vector<std::uint8_t>(1000));
    static_cast<void>(pool.take());
    EXPECT_EQ(pool.misses(), 0U);
    static_cast<void>(pool.take());
    EXPECT_EQ(pool.misses(), 1U);
}

TEST(FramePoolTest, PayloadsThatAreTooSmallAreNotKept) {
    FramePool pool;
    pool.reserve(1, 1000);
    static_cast<void>(pool.take());
    pool.give_back({});
    pool.give_back(std::vector<std::uint8_t>(999));
    EXPECT_EQ(pool.take().capacity(), 0U);
}

TEST(FramePoolTest, ThreadsShareIt) {
    FramePool pool;
    pool.reserve(2, 100);
    const auto use = [&pool] {
        for (int i = 0; i < 5000; ++i) {
            auto payload = pool.take();
            payload.assign(100, 1);
            pool.give_back(std::move(payload));
        }
    };
    std::thread other(use);
    use();
    other.join();
    EXPECT_EQ(pool.misses(), 0U);
}

}  // namespace
}  // namespace stipple
