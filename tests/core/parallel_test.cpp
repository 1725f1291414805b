#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace stipple {
namespace {

TEST(ParallelTest, CallsTheBodyOnceForEachIndex) {
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        std::vector<int> calls(1000, 0);
        parallel_for(0, 1000, [&](int i) { ++calls[static_cast<std::size_t>(i)]; });
        EXPECT_EQ(calls, std::vector<int>(1000, 1)) << threads << " threads";
    }
}

TEST(ParallelTest, DoesNothingForAnEmptyRange) {
    parallel_for(3, 3, [](int) { FAIL(); });
    parallel_for(4, 3, [](int) { FAIL(); });
}

TEST(ParallelTest, ThreadLimitHoldsWhileItLives) {
    const int before = thread_count();
    {
        const ThreadLimit limit(1);
        EXPECT_EQ(thread_count(), 1);
        std::atomic<bool> elsewhere = false;
        const auto here = std::this_thread::get_id();
        parallel_for(0, 100, [&](int) {
            if (std::this_thread::get_id() != here) elsewhere = true;
        });
        EXPECT_FALSE(elsewhere);
    }
    EXPECT_EQ(thread_count(), before);
}

TEST(ParallelTest, WhatRunsOnThisThreadUsesNoOther) {
    std::atomic<bool> elsewhere = false;
    std::vector<int> calls(1000, 0);
    std::thread worker([&] {
        const auto here = std::this_thread::get_id();
        run_on_this_thread([&] {
            parallel_for(0, 1000, [&](int i) {
                ++calls[static_cast<std::size_t>(i)];
                if (std::this_thread::get_id() != here) elsewhere = true;
            });
        });
    });
    worker.join();
    EXPECT_EQ(calls, std::vector<int>(1000, 1));
    EXPECT_FALSE(elsewhere);
}

TEST(ParallelTest, RethrowsAnExceptionOfTheBody) {
    const auto body = [](int i) {
        if (i == 17) throw std::runtime_error("seventeen");
    };
    EXPECT_THROW(parallel_for(0, 100, body), std::runtime_error);
}

}  // namespace
}  // namespace stipple
